// SPDX-License-Identifier: Apache-2.0
#include "core/base/system.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

TEST(FileLock, HasOneOwner) {
  const TempFolder temp;
  const std::filesystem::path file = temp.path() / ".lock";
  std::optional<FileLock> first = FileLock::take(file);
  ASSERT_TRUE(first);
  EXPECT_FALSE(FileLock::take(file));
  {
    const FileLock moved = std::move(*first);
    first.reset();
    EXPECT_FALSE(FileLock::take(file));
  }
  EXPECT_TRUE(FileLock::take(file));
  EXPECT_THROW(FileLock::take(temp.path() / "missing" / ".lock"), Error);
}

TEST(System, SaysWhatTheMachineIs) {
  EXPECT_FALSE(processor_name().empty());
  EXPECT_GT(memory_gib(), 0);
  EXPECT_TRUE(std::filesystem::exists(program_file()));
  EXPECT_EQ(utc_text("%Y").size(), 4u);
  const double thread = thread_seconds(), process = process_seconds();
  EXPECT_GE(thread_seconds(), thread);
  EXPECT_GE(process_seconds(), process);
}

TEST(TempFolder, GoesWithWhatIsInIt) {
  std::filesystem::path path;
  {
    const TempFolder temp;
    path = temp.path();
    EXPECT_TRUE(std::filesystem::is_empty(path));
    std::filesystem::create_directories(path / "a" / "b");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(AppendBytes, IsLittleEndian) {
  std::string out;
  append_bytes(out, uint32_t(0x04030201));
  append_bytes(out, std::vector<uint16_t>{0x0605, 0x0807});
  append_bytes(out, std::array<float, 1>{1.0f});
  append_bytes(out, std::vector<float>{});
  EXPECT_EQ(out, std::string("\1\2\3\4\5\6\7\x08\0\0\x80\x3f", 12));
}

}  // namespace
}  // namespace cei3d

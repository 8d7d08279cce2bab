// SPDX-License-Identifier: Apache-2.0
#include "core/base/system.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <memory>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/file.h"
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

TEST(FileLock, SaysWhatItsOwnerWrote) {
  const TempFolder temp;
  const std::filesystem::path file = temp.path() / ".lock";
  const std::optional<FileLock> lock = FileLock::take(file);
  ASSERT_TRUE(lock);
  for (const char* text : {"here, for long", "there", ""}) {
    EXPECT_TRUE(lock->write(text));
    EXPECT_EQ(read_file(file), text);
  }
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

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * double(::sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST(System, HolesGoBack) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "has an allocator of its own";
#endif
  const double before = resident_megabytes();
  std::vector<std::unique_ptr<std::string>> blocks;
  for (int i = 0; i < 100'000; ++i) blocks.push_back(std::make_unique<std::string>(1000, 'x'));
  for (size_t i = 0; i < blocks.size(); ++i)
    if (i % 100 < 99) blocks[i].reset();
  EXPECT_GT(resident_megabytes(), before + 60);
  give_back_freed_memory();
  EXPECT_LT(resident_megabytes(), before + 30);
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

// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

#include "core/base/error_of.h"
#include "core/base/hash.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

int files_in(const fs::path& folder) {
  return int(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(File, RoundTripsAnyBytesAndMakesFolders) {
  const TempFolder temp;
  const fs::path path = temp.path() / "a" / "b" / "file.bin";
  for (const size_t size : {0, 1, 4096, 65536, 300001}) {
    std::string bytes(size, '\0');
    for (size_t i = 0; i < size; ++i) bytes[i] = char(i * 131 >> 3);
    write_file_atomic(path, bytes);
    EXPECT_EQ(read_file(path), bytes);
  }
  EXPECT_EQ(files_in(path.parent_path()), 1);
}

TEST(File, ReadErrorsNameFileAndReason) {
  const TempFolder temp;
  EXPECT_THAT(message([&] { read_file(temp.path() / "none.png"); }),
              testing::AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
  EXPECT_THAT(message([&] { read_file(temp.path()); }), HasSubstr("folder"));
}

TEST(File, MissingPermissionLeavesNothing) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TempFolder temp;
  ::chmod(temp.path().c_str(), 0500);
  EXPECT_THAT(message([&] { write_file_atomic(temp.path() / "x", "data"); }), HasSubstr("permission"));
  ::chmod(temp.path().c_str(), 0700);
  EXPECT_EQ(files_in(temp.path()), 0);
}

TEST(File, ParentThatIsAFileIsAnError) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "x", "data");
  EXPECT_THAT(message([&] { write_file_atomic(temp.path() / "x" / "y", "data"); }), HasSubstr("Cannot"));
}

// A limit on file sizes stands in for the full disk: write() comes back short, then fails.
TEST(File, FailedWriteKeepsTheOldFile) {
  const TempFolder temp;
  const fs::path path = temp.path() / "x";
  write_file_atomic(path, "old");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  rlimit small = old;
  small.rlim_cur = 1000;
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string said = message([&] { write_file_atomic(path, std::string(5000, 'n')); });
  ::setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_THAT(said, HasSubstr("Cannot write"));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(files_in(temp.path()), 1);
}

TEST(File, FilesThatBelongTogetherAreAllWrittenOrNone) {
  const TempFolder temp;
  const fs::path a = temp.path() / "a", b = temp.path() / "below" / "b";
  write_files_atomic(std::vector<FileBytes>{{a, "one"}, {b, "two"}});
  EXPECT_EQ(read_file(a) + read_file(b), "onetwo");
  EXPECT_THAT(message([&] {
                write_files_atomic(std::vector<FileBytes>{{a, "new"}, {a / "c", "no"}});
              }),
              HasSubstr("Cannot"));
  EXPECT_EQ(read_file(a), "one");
  EXPECT_EQ(files_in(temp.path()), 2);
}

TEST(File, WhetherItCanBeWrittenIsKnownBefore) {
  const TempFolder temp;
  require_writable(temp.path() / "new" / "folder" / "file");
  require_writable("file_in_the_working_folder");
  EXPECT_EQ(files_in(temp.path()), 0);
  write_file_atomic(temp.path() / "file", "x");
  require_writable(temp.path() / "file");
  EXPECT_THAT(message([&] { require_writable(temp.path() / "file" / "below"); }), HasSubstr("not a folder"));
  EXPECT_THAT(message([&] { require_writable(temp.path()); }), HasSubstr("folder"));
}

TEST(File, TargetThatIsAFolderIsAnError) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "target" / "inside", "x");
  EXPECT_THAT(message([&] { write_file_atomic(temp.path() / "target", "data"); }), HasSubstr("folder"));
  EXPECT_EQ(files_in(temp.path()), 1);
}

// Published vectors of XXH3-128, seed 0: the empty input.
TEST(Hash, KnownValueAndShape) {
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_NE(content_hash("a"), content_hash("b"));
  EXPECT_EQ(content_hash("a").size(), 32u);
}

}  // namespace
}  // namespace cei3d

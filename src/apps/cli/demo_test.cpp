// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/cli/demo_page.h"
#include "apps/cli/demo_sample.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

TEST(Demo, SampleIsBesideTheInstalledProgramOrAboveTheOneThatWasBuilt) {
  const TempFolder temp;
  const auto prefix = temp.path() / "prefix", source = temp.path() / "source";
  write_file_atomic(prefix / "share/cei3d/samples/spot/transforms_train.json", "{}");
  write_file_atomic(source / "samples/spot/transforms_train.json", "{}");
  EXPECT_EQ(demo_sample(prefix / "bin/cei3d"), prefix / "share/cei3d/samples/spot");
  EXPECT_EQ(demo_sample(source / "build/release/cei3d"), source / "samples/spot");
}

TEST(Demo, MissingSampleIsASentenceThatSaysWhatToDo) {
  const TempFolder temp;
  const Error e = error_of([&] { demo_sample(temp.path() / "bin/cei3d"); });
  EXPECT_EQ(e.code(), ErrorCode::failed);
  EXPECT_THAT(e.what(), HasSubstr((temp.path() / "share/cei3d/samples/spot").string()));
  EXPECT_THAT(e.hint(), HasSubstr("--sample"));
  EXPECT_THAT(message([] { demo_sample(""); }), HasSubstr("missing"));
}

TEST(Demo, PageShowsEveryPicture) {
  const std::string page = demo_page({"r_1", "r_2"}, {"000", "001"}, {});
  for (const char* file : {"photo_r_2.png", "before/normal/r_1.png", "painted/albedo/r_2.png",
                           "turned/rgb/r_1.png", "turntable/rgb/001.png"})
    EXPECT_THAT(page, HasSubstr(std::string("src=\"") + file + "\""));
}

TEST(Demo, PageLinksEveryFileAndSaysItsSize) {
  const std::string page =
      demo_page({}, {}, {{"spot.glb", "textured", 6'149'000}, {"spot.mtl", "beside it", 312}});
  EXPECT_THAT(page, HasSubstr("<a href=\"spot.glb\">spot.glb</a>: textured; 6.1 MB"));
  EXPECT_THAT(page, HasSubstr("<a href=\"spot.mtl\">spot.mtl</a>: beside it; 0 kB"));
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/session/cameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;

Camera camera_at(Vec3d center) {
  Camera c;
  c.width = 80;
  c.height = 60;
  c.fx = c.fy = 100;
  c.cx = 41;
  c.cy = 28;
  c.center = center;
  return c;
}

Capture capture_of(const std::vector<std::pair<std::string, Split>>& views, Vec3d up) {
  Capture c;
  c.root = "/photos";
  c.format = "nerf-synthetic";
  c.up = up;
  int i = 0;
  for (const auto& [name, split] : views) {
    const double a = 2.1 * i++;
    View v;
    v.name = name;
    v.split = split;
    v.camera = camera_at(Vec3d{1, 2, 3} + Vec3d{4 * std::cos(a), 4 * std::sin(a), 1});
    c.views.push_back(v);
  }
  return c;
}

class CamerasTest : public ::testing::Test {
 protected:
  Project make(const Capture& capture) {
    return Project::create(temp_.path() / "p", {{{1, 2, 3}, 0.5}, Json::object()}, capture, false);
  }
  TempFolder temp_;
};

TEST_F(CamerasTest, TurntableLooksAtTheObjectFromOneDistance) {
  for (const Vec3d up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0}}) {
    const Normalization n{{1, 2, 3}, 0.5};
    const std::vector<NamedCamera> cameras =
        turntable(capture_of({{"a", Split::train}, {"b", Split::train}}, up), n, 7);
    ASSERT_EQ(cameras.size(), 7u);
    std::set<std::string> names;
    for (const NamedCamera& c : cameras) {
      names.insert(c.name);
      const Vec3d seen = c.camera.project(n.center);
      EXPECT_NEAR(seen.x, 40, 1e-9);
      EXPECT_NEAR(seen.y, 30, 1e-9);
      EXPECT_NEAR(seen.z, std::sqrt(17), 1e-9);
      EXPECT_LT(c.camera.project(n.center + up * 0.1).y, 30);  // up is up in the picture
      const Mat3d& r = c.camera.world_from_cam;
      EXPECT_NEAR(dot(cross(r.row[0], r.row[1]), r.row[2]), 1, 1e-9);  // a rotation
    }
    EXPECT_EQ(names.size(), 7u);
  }
}

TEST_F(CamerasTest, AnotherSizeKeepsTheFieldOfView) {
  const Camera c = camera_at({0, 0, -5}), d = resized(c, 160, 90);
  const Vec3d p{0.3, -0.2, 1};
  EXPECT_NEAR(d.project(p).x, 2 * c.project(p).x, 1e-9);
  EXPECT_NEAR(d.project(p).y - 45, 2 * (c.project(p).y - 30), 1e-9);
}

TEST_F(CamerasTest, FilesAreNamedLikeViews) {
  const Project p = make(capture_of(
      {{"train/r_0", Split::train}, {"train/r_1", Split::train}, {"test/r_1", Split::test}}, {0, 0, 1}));
  const std::vector<View> all = choose_views(p, "", std::nullopt);
  EXPECT_EQ(all.size(), 3u);
  EXPECT_EQ(choose_views(p, "", Split::test).size(), 1u);
  EXPECT_EQ(message([&] { choose_views(p, "", Split::val); }),
            "/photos has no val views; it has train, test.");
  const std::vector<NamedCamera> own = choose_cameras(p, ProjectViews{}, 0, 0);  // the held-out ones
  ASSERT_EQ(own.size(), 1u);
  EXPECT_EQ(own[0].file, "r_1");
}

TEST_F(CamerasTest, CameraFilesComeBackExactly) {
  const Project p = make(capture_of({{"train/r_0", Split::train}}, {0, 0, 1}));
  const Camera c = camera_at({1.0 / 3, 0, -5});
  Json one = {{"name", "x/a"}}, two = {{"name", "y/a"}}, three = {{"name", "y/b"}};
  for (Json* j : {&one, &two, &three}) j->update(camera_json(c));
  const auto file = temp_.path() / "c.json";
  write_file_atomic(file, Json{{"cameras", {one, two, three}}}.dump());
  EXPECT_TRUE(is_camera_file(file));
  const std::vector<NamedCamera> cameras = choose_cameras(p, CameraFile{file}, 0, 0);
  ASSERT_EQ(cameras.size(), 3u);
  EXPECT_EQ(cameras[0].file, "x/a");  // two views share the last part
  EXPECT_EQ(cameras[2].file, "b");
  EXPECT_EQ(cameras[0].camera.center.x, c.center.x);
}

TEST_F(CamerasTest, DamagedCameraFilesAreRefused) {
  const Project p = make(capture_of({{"train/r_0", Split::train}}, {0, 0, 1}));
  const auto file = temp_.path() / "c.json";
  Json outside = {{"name", "../../etc/x"}}, flat = {{"name", "a"}};
  outside.update(camera_json(camera_at({0, 0, 0})));
  Camera no_size = camera_at({0, 0, 0});
  no_size.width = 0;
  flat.update(camera_json(no_size));
  Json extra = {{"name", "a"}, {"distortion", 0.1}};
  extra.update(camera_json(camera_at({0, 0, -3})));
  Json two_rows = extra;
  two_rows.erase("distortion");
  two_rows["world_from_cam"].erase(2);
  for (const std::string& text :
       {std::string("{"), std::string("[]"), std::string(R"({"cameras": 3})"),
        std::string(R"({"cameras": []})"), std::string(R"({"cameras": [{"name": "a"}]})"),
        Json{{"cameras", Json::array({outside})}}.dump(), Json{{"cameras", Json::array({extra})}}.dump(),
        Json{{"cameras", Json::array({two_rows})}}.dump(),
        std::string(R"({"cameras": )") + std::string(300'000, '['),
        Json{{"cameras", Json::array({flat})}}.dump()}) {
    write_file_atomic(file, text);
    EXPECT_THROW(choose_cameras(p, CameraFile{file}, 0, 0), Error) << text;
  }
}

// What a reconstruction found out about masks holds for the capture however it is named.
TEST_F(CamerasTest, ViewsOfTheObjectsCaptureKeepWhatIsDoubtful) {
  const fs::path photos = temp_.path() / "photos", doubtful = temp_.path() / "p/doubtful/r_001.png";
  const TestBall ball;
  write_nerf_split(photos, "train", ball, test_views(ball, 3));
  Capture known = load_capture(photos);
  known.views[1].doubtful_path = doubtful;
  const Project p = make(known);
  for (const fs::path& named : {fs::path(), photos}) {
    const std::vector<View> views = choose_views(p, named, std::nullopt);
    EXPECT_EQ(views.at(0).doubtful_path, "");
    EXPECT_EQ(views.at(1).doubtful_path, doubtful);
  }
  // Also where the split is that of the reconstruction.
  Capture split = load_capture(photos, {"", 2});
  split.views[1].doubtful_path = doubtful;
  const Project q =
      Project::create(temp_.path() / "q", {{{1, 2, 3}, 0.5}, {{"test_every", 2}}}, split, false);
  for (const fs::path& named : {fs::path(), photos}) {
    EXPECT_EQ(choose_views(q, named, Split::test).size(), views_of(split, Split::test).size());
    for (const View& v : choose_views(q, named, std::nullopt))
      EXPECT_EQ(v.doubtful_path.empty(), v.name != split.views[1].name) << v.name;
  }
  write_nerf_split(photos, "train", ball, test_views(ball, 4));  // another capture
  EXPECT_EQ(choose_views(p, photos, std::nullopt).at(1).doubtful_path, "");
}

}  // namespace
}  // namespace cei3d

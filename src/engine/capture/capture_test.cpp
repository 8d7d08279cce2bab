// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/capture.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "core/math/color.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/test_capture.h"

namespace cei3d {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

void expect_same_camera(const Camera& a, const Camera& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  for (const Vec3d p : {Vec3d{0.3, -0.2, 0.5}, Vec3d{1, 0.1, 0.2}, Vec3d{-0.4, 0.5, 1.1}}) {
    const Vec3d u = a.project(p), v = b.project(p);
    EXPECT_NEAR(length(u - v), 0, 1e-6);
  }
}

TEST(Capture, SameBallInBothFormatsGivesTheSameCameras) {
  const TempFolder temp;
  const TestBall ball;
  const auto train = test_views(ball, 8), test = test_views(ball, 3);
  write_nerf_split(temp.path() / "nerf", "train", ball, train);
  write_nerf_split(temp.path() / "nerf", "test", ball, test);
  write_physg(temp.path() / "physg" / "train", ball, train);
  write_physg(temp.path() / "physg" / "test", ball, test);
  const Capture a = load_capture(temp.path() / "nerf"), b = load_capture(temp.path() / "physg");
  EXPECT_EQ(a.format, "nerf-synthetic");
  EXPECT_EQ(b.format, "physg");
  ASSERT_EQ(a.views.size(), 11u);
  ASSERT_EQ(b.views.size(), 11u);
  for (size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].name, b.views[i].name);
    EXPECT_EQ(a.views[i].split, b.views[i].split);
    expect_same_camera(a.views[i].camera, b.views[i].camera);
    if (i < 8) expect_same_camera(a.views[i].camera, train[i].camera);
    const Image u = load_linear_rgba(a.views[i]), v = load_linear_rgba(b.views[i]);
    EXPECT_EQ(u.data, v.data);
  }
  EXPECT_EQ(a.up.z, 1);
  EXPECT_EQ(b.up.z, 1);
  EXPECT_TRUE(a.warnings.empty());
  EXPECT_TRUE(b.warnings.empty());
}

// The silhouette's center of a ball lies where its center projects, nearly: catches half pixels and flipped
// axes.
TEST(Capture, PicturesAndCamerasAgree) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path(), "train", ball, test_views(ball, 4));
  for (const View& v : load_capture(temp.path()).views) {
    const Mask mask = load_mask(v);
    double x = 0, y = 0, n = 0;
    for (int r = 0; r < mask.height; ++r)
      for (int c = 0; c < mask.width; ++c)
        if (mask.object[size_t(r) * mask.width + c]) x += c + 0.5, y += r + 0.5, ++n;
    const Vec3d p = v.camera.project(ball.center);
    EXPECT_NEAR(x / n, p.x, 0.3);  // perspective moves it by up to 0.2
    EXPECT_NEAR(y / n, p.y, 0.3);
  }
}

TEST(Capture, FolderFileAndFlatPhysgAreAccepted) {
  const TempFolder temp;
  const TestBall ball;
  write_physg(temp.path() / "p", ball, test_views(ball, 5));
  EXPECT_EQ(load_capture(temp.path() / "p").views.size(), 5u);
  EXPECT_EQ(load_capture(temp.path() / "p" / "cam_dict_norm.json").views.size(), 5u);
  write_nerf_split(temp.path() / "n", "train", ball, test_views(ball, 5));
  EXPECT_EQ(load_capture(temp.path() / "n" / "transforms_train.json").views.size(), 5u);
}

TEST(Capture, FrameIntrinsicsWinAndMaskPathsAreRead) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 2);
  Json j{{"fl_x", 10.0}, {"w", 64}, {"h", 48}, {"frames", Json::array()}};
  for (const TestView& v : views) {
    Json frame = nerf_frame("images/" + v.stem + ".png", v.camera);
    frame["fl_x"] = v.camera.fx;
    frame["cx"] = 31.0;
    frame["mask_path"] = "masks/" + v.stem + ".png";
    j["frames"].push_back(frame);
    write_png(temp.path() / "images" / (v.stem + ".png"), ball_image(ball, v.camera));
    Image mask(64, 48, 1);
    mask.at(3, 4)[0] = 1;
    mask.at(4, 4)[0] = 0.5f;
    mask.at(5, 4)[0] = 0.03f;
    mask.at(6, 4)[0] = 0.97f;
    write_png(temp.path() / "masks" / (v.stem + ".png"), mask);
  }
  write_file_atomic(temp.path() / "transforms.json", j.dump());
  const Capture capture = load_capture(temp.path());
  EXPECT_EQ(capture.views[0].name, "images/r_000");
  EXPECT_DOUBLE_EQ(capture.views[0].camera.fx, views[0].camera.fx);
  EXPECT_DOUBLE_EQ(capture.views[0].camera.cx, 31.0);
  const Image image = load_linear_rgba(capture.views[0]);
  EXPECT_EQ(image.at(3, 4)[3], 1);
  EXPECT_EQ(image.at(32, 24)[3], 0);  // the mask file wins over alpha
  EXPECT_NEAR(image.at(4, 4)[3], 0.5f, 0.01f);
  EXPECT_EQ(image.at(5, 4)[3], 0);  // what compression leaves of black and white
  EXPECT_EQ(image.at(6, 4)[3], 1);
  EXPECT_EQ(load_mask(capture.views[0]).object[4 * 64 + 6], 1);
  EXPECT_EQ(load_mask(capture.views[0]).object[4 * 64 + 5], 0);
}

TEST(Capture, NerfstudioListsOfFilesAreSplits) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path(), "train", ball, test_views(ball, 6));
  Json j = Json::parse(read_file(temp.path() / "transforms_train.json"));
  fs::remove(temp.path() / "transforms_train.json");
  const auto path = [&](size_t i) { return j["frames"][i]["file_path"]; };
  j["train_filenames"] = {path(0), path(3)};
  j["test_filenames"] = {path(4), path(1)};
  j["camera_model"] = "OPENCV";
  write_file_atomic(temp.path() / "transforms.json", j.dump());
  const Capture capture = load_capture(temp.path(), {"", 2});
  EXPECT_EQ(views_of(capture, Split::train).size(), 4u);
  ASSERT_EQ(views_of(capture, Split::test).size(), 2u);
  EXPECT_EQ(views_of(capture, Split::test)[1].name, "train/r_004");
  j["camera_model"] = "EQUIRECTANGULAR";
  write_file_atomic(temp.path() / "transforms.json", j.dump());
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("EQUIRECTANGULAR"));
  j["camera_model"] = "OPENCV";
  j["test_filenames"] = 3;
  write_file_atomic(temp.path() / "transforms.json", j.dump());
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("list of file names"));
}

TEST(Capture, TestEveryHoldsViewsOut) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path(), "train", ball, test_views(ball, 10));
  const Capture capture = load_capture(temp.path(), {"", 4});
  EXPECT_EQ(views_of(capture, Split::train).size(), 7u);
  ASSERT_EQ(views_of(capture, Split::test).size(), 3u);
  EXPECT_EQ(views_of(capture, Split::test)[1].name, "train/r_004");
  EXPECT_EQ(capture.views.back().split, Split::test);
  EXPECT_THROW(load_capture(temp.path(), {"", 1}), Error);
}

TEST(Capture, ARandomSplitInPlaceOfItsOwnIsRefused) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path(), "train", ball, test_views(ball, 10));
  CaptureOptions random;
  random.test_share = 0.3;
  EXPECT_EQ(views_of(load_capture(temp.path(), random), Split::test).size(), 3u);
  write_nerf_split(temp.path(), "test", ball, test_views(ball, 3));
  const Error e = error_of([&] { load_capture(temp.path(), random); });
  EXPECT_EQ(e.code(), ErrorCode::usage);
  EXPECT_THAT(e.what(), HasSubstr("a split of its own"));
}

TEST(Capture, PhysgFallsBackToOrderAndSaysSo) {
  const TempFolder temp;
  const TestBall ball;
  const auto views = test_views(ball, 3);
  write_physg(temp.path(), ball, views);
  for (int i = 0; i < 3; ++i)
    fs::rename(temp.path() / "image" / (views[i].stem + ".png"),
               temp.path() / "image" / fmt::format("photo{}.png", i));
  const Capture capture = load_capture(temp.path());
  ASSERT_EQ(capture.warnings.size(), 1u);
  EXPECT_THAT(capture.warnings[0], HasSubstr("order"));
  EXPECT_EQ(capture.views[2].image_path.filename(), "photo2.png");
  fs::remove(temp.path() / "image" / "photo1.png");
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("neither by name nor by number"));
}

Capture named_views() {
  Capture c;
  for (const char* name : {"train/r_001", "train/r_055", "test/r_055", "test/r_200"}) {
    View v;
    v.name = name;
    v.split = *split_from_name(fs::path(name).begin()->string());
    c.views.push_back(v);
  }
  return c;
}

TEST(Capture, FindsViewsByTheirNames) {
  const Capture c = named_views();
  for (const char* name :
       {"train/r_055", "./train/r_055", "train/r_055.png", "./train/r_055.JPG", "r_055", "r_055.png"})
    EXPECT_EQ(find_view(c, name).name, "train/r_055") << name;
  EXPECT_EQ(find_view(c, "r_200").name, "test/r_200");
  EXPECT_EQ(find_view(c, "test/r_055").name, "test/r_055");
  EXPECT_THAT(message([&] { find_view(c, "train/r_005"); }),
              AllOf(HasSubstr("train/r_005"), HasSubstr("train/r_055")));
  EXPECT_THROW(find_view(c, ""), Error);
}

TEST(Capture, ParsesSpecs) {
  const TempFolder temp;
  const std::string folder = temp.path().string();
  EXPECT_EQ(parse_capture_spec(folder).split, std::nullopt);
  EXPECT_EQ(parse_capture_spec(folder + ":test").path, folder);
  EXPECT_EQ(parse_capture_spec(folder + ":test").split, Split::test);
  EXPECT_THROW(parse_capture_spec(folder + ":tset"), Error);
  fs::create_directory(folder + "/a:test");
  EXPECT_EQ(parse_capture_spec(folder + "/a:test").split, std::nullopt);
}

struct BadFile {
  const char* name;
  const char* text;
  const char* says;
};

constexpr BadFile kBadFiles[] = {
    {"transforms_train.json", "", "not valid JSON"},
    {"transforms_train.json", "{\"frames\": [", "not valid JSON"},
    {"transforms_train.json", "{\"frames\": [1e999]}", "too large"},
    {"transforms_train.json", "[]", "no list of frames"},
    {"transforms_train.json", "{\"frames\": 3}", "no list of frames"},
    {"transforms_train.json", "{\"frames\": []}", "no views"},
    {"transforms_train.json", "{\"frames\": [{\"file_path\": \"a\"}]}", "lacks"},
    {"transforms_train.json", "{\"frames\": [{\"file_path\": 7, \"transform_matrix\": []}]}", "lacks"},
    {"transforms_train.json", "{\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": [[1,2],[3]]}]}",
     "matrix"},
    {"transforms_train.json", "{\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": \"x\"}]}",
     "matrix"},
    {"transforms_train.json",
     "{\"frames\": [{\"file_path\": \"..\", \"transform_matrix\": [1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "names no image"},
    {"transforms_train.json",
     "{\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": [\"1\",0,0,0,0,1,0,0,0,0,1,0]}]}", "number"},
    {"transforms_train.json",
     "{\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": [1,0,0,0,0,1,0,0,0,0,1,0]}]}", "image size"},
    {"transforms_train.json",
     "{\"w\":8,\"h\":8,\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": "
     "[1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "focal"},
    {"transforms_train.json",
     "{\"w\":8,\"h\":8,\"fl_x\":-4,\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": "
     "[1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "impossible"},
    {"transforms_train.json",
     "{\"w\":1e9,\"h\":8,\"fl_x\":4,\"frames\": [{\"file_path\": \"a\", \"transform_matrix\": "
     "[1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "impossible"},
    {"transforms_train.json",
     "{\"w\":8,\"h\":8,\"camera_angle_x\":4,\"frames\": [{\"file_path\": \"a\", "
     "\"transform_matrix\": [1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "field of view"},
    {"transforms_train.json",
     "{\"w\":8,\"h\":8,\"fl_x\":4,\"k1\":\"x\",\"frames\": [{\"file_path\": \"a\", "
     "\"transform_matrix\": [1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "number"},
    {"transforms_train.json",
     "{\"w\":8,\"h\":8,\"fl_x\":4,\"k1\":-9,\"frames\": [{\"file_path\": \"a\", "
     "\"transform_matrix\": [1,0,0,0,0,1,0,0,0,0,1,0]}]}",
     "coefficients"},
    {"cam_dict_norm.json", "[]", "not a list of cameras"},
    {"cam_dict_norm.json", "{}", "no views"},
    {"cam_dict_norm.json", "{\"a.png\": {\"K\": []}}", "lacks"},
    {"cam_dict_norm.json", "{\"a.png\": {\"K\": [1], \"W2C\": [1]}}", "matrix"},
};

TEST(Capture, BadCameraFilesAreErrors) {
  for (const BadFile& bad : kBadFiles) {
    const TempFolder temp;
    write_file_atomic(temp.path() / bad.name, bad.text);
    EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr(bad.says)) << bad.text;
  }
  const TempFolder temp;
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("not a capture"));
  EXPECT_THAT(message([&] { load_capture(temp.path() / "none"); }), HasSubstr("no capture at"));
  EXPECT_THAT(message([&] {
                load_capture(temp.path(), {"olmap", 0});
              }),
              HasSubstr("Known: nerf-synthetic, physg, idr"));
}

Json frames_of(const std::string& file_path) {
  return {{"w", 8}, {"h", 8}, {"fl_x", 8.0}, {"frames", {nerf_frame(file_path, Camera())}}};
}

TEST(Capture, NamesNeverLeadOutOfAFolder) {
  const TempFolder temp;
  for (const char* path : {"../r_1", "a/../../r_1"}) {
    write_file_atomic(temp.path() / "transforms_train.json", frames_of(path).dump());
    EXPECT_EQ(load_capture(temp.path()).views[0].name, "train/r_1") << path;
  }
}

TEST(Capture, NamesThatNoFileCanHaveAreErrors) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "transforms_train.json", frames_of(std::string(5000, 'a')).dump());
  EXPECT_THAT(message([&] { load_capture(temp.path()); }), HasSubstr("File name too long"));
}

// A capture may name images in its own folder or beside it, and none elsewhere, whether they exist or not.
TEST(Capture, FilesElsewhereAreNotOpened) {
  const TempFolder temp;
  const std::filesystem::path home = temp.path() / "mine/capture", secret = temp.path() / "secret.png";
  write_png(secret, Image(8, 8, 3, 0.5f));
  write_png(temp.path() / "mine/images/a.png", Image(8, 8, 3, 0.5f));
  const auto load = [&](const Json& j, const std::string& file) {
    write_file_atomic(home / file, j.dump());
    return load_capture(home).views[0];
  };
  for (const std::string& path :
       {std::string("../../secret.png"), secret.string(), std::string("/etc/passwd"),
        std::string("a/../../../secret"), std::string("..\\..\\secret.png")}) {
    const auto says = AllOf(HasSubstr("frame 0 of"), HasSubstr("outside of the capture's folder"));
    EXPECT_THAT(message([&] { load(frames_of(path), "transforms.json"); }), says) << path;
    Json masked = frames_of("a.png");
    masked["frames"][0]["mask_path"] = path;
    EXPECT_THAT(message([&] { load(masked, "transforms.json"); }), says) << path;
  }
  const std::filesystem::path beside = temp.path() / "mine/images/a.png";
  EXPECT_EQ(load(frames_of("../images/a.png"), "transforms.json").image_path.filename(), "a.png");
  EXPECT_EQ(load(frames_of(beside.string()), "transforms.json").image_path, beside);
}

TEST(Capture, IsFoundByAPathThatLeadsUpFromTheCurrentFolder) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "transforms.json", frames_of("images/a.png").dump());
  const fs::path relative = fs::relative(temp.path());
  ASSERT_EQ(*relative.begin(), "..");
  EXPECT_EQ(load_capture(relative).views[0].image_path, relative / "images/a.png");
}

TEST(Capture, NanInJsonIsReadAsNan) {
  const TempFolder temp;
  std::string text =
      Json{{"w", 8}, {"h", 8}, {"fl_x", 8.0}, {"frames", {nerf_frame("NaN/r_1", Camera())}}}.dump();
  text.replace(text.find("[[1.0"), 5, "[[NaN");
  write_file_atomic(temp.path() / "transforms_train.json", text);
  const View v = load_capture(temp.path()).views[0];
  EXPECT_EQ(v.name, "NaN/r_1");
  EXPECT_TRUE(std::isnan(v.camera.world_from_cam.row[0].x));
}

TEST(CaptureImages, BadPicturesAreErrorsThatNameTheFile) {
  const TempFolder temp;
  View v;
  v.name = "train/x";
  v.camera.width = 4, v.camera.height = 4;
  EXPECT_THAT(message([&] { load_linear_rgba(v); }), HasSubstr("no photograph"));
  v.image_path = temp.path() / "x.png";
  EXPECT_THAT(message([&] { load_linear_rgba(v); }), HasSubstr("x.png"));
  write_png(v.image_path, Image(5, 4, 4, 0.5f));
  EXPECT_THAT(message([&] { load_linear_rgba(v); }), AllOf(HasSubstr("5 x 4"), HasSubstr("4 x 4")));
  EXPECT_THAT(message([&] { load_mask(v); }), HasSubstr("5 x 4"));
  write_png(v.image_path, Image(4, 4, 4, 0.5f));
  v.mask_path = temp.path() / "m.png";
  EXPECT_THAT(message([&] { load_linear_rgba(v); }), HasSubstr("m.png"));
  write_png(v.mask_path, Image(4, 8, 1, 1.0f));
  EXPECT_THAT(message([&] { load_mask(v); }), HasSubstr("m.png"));
  v.mask_path.clear();
  Image nan(4, 4, 3, 0.5f);
  nan.data[7] = NAN;
  v.image_path = temp.path() / "x.exr";
  write_exr(v.image_path, nan);
  EXPECT_THAT(message([&] { load_linear_rgba(v); }), HasSubstr("NaN"));
}

TEST(CaptureImages, LinearStraightAlphaAndDownscale) {
  const TempFolder temp;
  View v;
  v.camera.width = 4, v.camera.height = 4;
  v.image_path = temp.path() / "x.png";
  write_png(v.image_path, Image(4, 4, 4, 51.0f / 255));
  const Image image = load_linear_rgba(v);
  EXPECT_FLOAT_EQ(image.at(1, 1)[0], linear_from_srgb(0.2f));
  EXPECT_FLOAT_EQ(image.at(1, 1)[3], 0.2f);
  EXPECT_EQ(CaptureImages(2).load(v).width, 2);
  const Camera half = scaled(Camera{4, 4, 8, 8, 2, 2, 0, Mat3d::identity(), {0, 0, 0}}, 2);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.project({1, 1, 8}).x * 2,
            (Camera{4, 4, 8, 8, 2, 2, 0, Mat3d::identity(), {0, 0, 0}}.project({1, 1, 8}).x));
  View gray = v;
  gray.image_path = temp.path() / "g.png";
  write_png(gray.image_path, Image(4, 4, 1, 1.0f));
  EXPECT_EQ(load_linear_rgba(gray).at(0, 0)[2], 1.0f);
  EXPECT_FALSE(load_mask(gray).stated);
}

}  // namespace
}  // namespace cei3d

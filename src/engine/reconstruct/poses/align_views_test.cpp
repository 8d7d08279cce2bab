// SPDX-License-Identifier: Apache-2.0
// A checkered box whose cameras are given a little wrong, or right.
#include "engine/reconstruct/poses/align_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rigid_motion.h"
#include "core/math/rng.h"
#include "engine/reconstruct/poses/refined_cameras.h"
#include "engine/reconstruct/presets.h"
#include "engine/reconstruct/test_box.h"
#include "engine/reconstruct/test_run.h"
#include "engine/reconstruct/training_views.h"

namespace cei3d {
namespace {

constexpr int kViews = 16, kSize = 96;

Camera true_camera(int view) { return box_camera(-0.6 + 1.4 * view / kViews, 2.4 * view, kSize); }

RigidMotion disturbance(int view, double size) {
  Rng rng(3, 1, uint64_t(view));
  const auto vector = [&] { return Vec3d{rng.normal(), rng.normal(), rng.normal()} * size; };
  return {vector(), vector()};
}

Image checkered_picture(const Camera& camera) {
  return filtered_box_picture(camera, [](Vec3f p) {
    const bool odd = (int(std::floor(p.x * 5)) + int(std::floor(p.y * 5)) + int(std::floor(p.z * 5))) & 1;
    return odd ? Vec3f{0.5f, 0.3f, 0.2f} : Vec3f{0.1f, 0.3f, 0.4f};
  });
}

PixelStore photographs(double wrong) {
  PixelStore store;
  for (int v = 0; v < kViews; ++v)
    store.add_view(moved(true_camera(v), disturbance(v, wrong)), checkered_picture(true_camera(v)), 6);
  return store;
}

TrialOptions brief_trials() {
  TrialOptions o = preset_by_name("fast").trial;
  o.geometry.sdf.encoding = {0, 6, 8, 64, 12};
  o.geometry.rays = 1024;
  o.geometry.prefit_steps = 100;
  o.shapes.cells = o.shapes.stereo_cells = 48;
  o.shapes.carving.steps = 20;
  o.steps = 400;
  o.align = true;
  return o;
}

// The corners of the box on the side of the camera.
std::vector<Vec3d> corners_before(const Camera& camera) {
  std::vector<Vec3d> corners;
  for (int c = 0; c < 8; ++c) {
    const Vec3d p{c & 1 ? 0.45 : -0.45, c & 2 ? 0.45 : -0.45, c & 4 ? 0.4 : -0.4};
    if (dot(p, camera.center) > 0) corners.push_back(p);
  }
  return corners;
}

// Root mean square over views and corners of how far the image of the box is off, in pixels, but for what all
// cameras have in common, which no alignment can know.
double off_by(const PixelStore& store) {
  std::vector<Alignment> missing;
  for (int v = 0; v < kViews; ++v) {
    const Camera& camera = store.cameras()[size_t(v)];
    missing.push_back(
        {motion_between(camera, true_camera(v)), 0, information_of(camera, corners_before(camera))});
  }
  keep_frame(store.cameras(), missing);
  double sum = 0;
  int points = 0;
  for (int v = 0; v < kViews; ++v) {
    const Camera& camera = store.cameras()[size_t(v)];
    for (const Vec3d p : corners_before(camera)) {
      const Vec3d d = moved(camera, missing[size_t(v)].motion).project(p) - camera.project(p);
      sum += d.x * d.x + d.y * d.y;
      ++points;
    }
  }
  return std::sqrt(sum / points);
}

TEST(AlignViews, AModelBringsCamerasBackThatAreALittleWrong) {
  const Device device = make_device();
  const PixelStore right = photographs(0);
  const TrialOptions o = brief_trials();
  GeometryStage model(device, right, o.geometry, 1);
  model.prefit(start_shape(right, Start::hull, 1, o.shapes));
  for (int step = 0; step < o.steps; ++step) model.step(step, double(step) / o.steps);
  PixelStore store = photographs(0.012);
  const double before = off_by(store);
  ASSERT_GT(before, 0.9);
  store.set_cameras(align_views(show_views(model, store, kSize, Progress()), store).cameras);
  EXPECT_LT(off_by(store), 0.65 * before) << before;  // by a model of 96 pixels and 400 steps
}

// Views that are brighter or darker, each channel by itself.
Vec3f exposure(int view) {
  Rng rng(9, 2, uint64_t(view));
  Vec3f e;
  for (int c = 0; c < 3; ++c) e[c] = std::exp(0.25f * rng.normal());
  return e;
}

PixelStore exposed_photographs() {
  PixelStore store;
  for (int v = 0; v < kViews; ++v) {
    Image image = checkered_picture(true_camera(v));
    for (size_t i = 0; i < image.data.size(); ++i)
      if (i % 4 < 3) image.data[i] *= exposure(v)[int(i % 4)];
    store.add_view(true_camera(v), image, 6);
  }
  return store;
}

// A model that is right shows what photographs of one exposure show.
ShownViews shown_by_a_right_model(const PixelStore& store, int reduction) {
  const PixelStore right = photographs(0);
  ShownViews views;
  views.reductions.assign(kViews, reduction);
  views.photographs = photographs_over_white(store, views.reductions);
  views.models.resize(kViews);
  const std::vector<Image> pictures = photographs_over_white(right, views.reductions);
  for (int v = 0; v < kViews; ++v) {
    const Camera camera = scaled(true_camera(v), reduction);
    ModelView& model = views.models[size_t(v)];
    model.srgb = pictures[size_t(v)];
    model.depth = Image(camera.width, camera.height, 1);
    const Image coverage = box_picture(camera, [](Vec3f) { return Vec3f{0, 0, 0}; });
    for (size_t i = 0; i < model.depth.data.size(); ++i) model.depth.data[i] = coverage.data[4 * i + 3];
  }
  return views;
}

// Root mean square of how far the logarithms of the store's exposures are off, but for their mean, which
// nothing can tell.
double exposures_off_by(const PixelStore& store) {
  std::vector<Vec3f> truth;
  Vec3d mean{0, 0, 0};
  for (int v = 0; v < kViews; ++v) {
    truth.push_back(exposure(v));
    for (int c = 0; c < 3; ++c) mean[c] += std::log(double(truth.back()[c])) / kViews;
  }
  for (Vec3f& e : truth)
    for (int c = 0; c < 3; ++c) e[c] = float(e[c] * std::exp(-mean[c]));
  return exposure_change(truth, store.exposures());
}

TEST(Exposures, AreFoundByAModelThatIsRight) {
  PixelStore store = exposed_photographs();
  ASSERT_GT(exposures_off_by(store), 0.2);
  for (const int reduction : {1, 2}) {
    PixelStore found = store;
    found.set_exposures(find_exposures(shown_by_a_right_model(store, reduction), store));
    EXPECT_LT(exposures_off_by(found), 0.01) << reduction;
    // With these exposures the photographs are those of the model: nothing is left to find.
    const std::vector<Vec3f> again = find_exposures(shown_by_a_right_model(found, reduction), found);
    EXPECT_LT(exposure_change(found.exposures(), again), 0.003) << reduction;
  }
}

TEST(Exposures, OfAViewThatShowsNothingStayAsTheyAre) {
  PixelStore store = exposed_photographs();
  ShownViews views = shown_by_a_right_model(store, 1);
  for (float& depth : views.models[3].depth.data) depth = 0;
  const std::vector<Vec3f> found = find_exposures(views, store);
  // All are divided by their mean; that of the empty view is 1 before.
  Vec3d mean{0, 0, 0};
  for (int v = 0; v < kViews; ++v)
    for (int c = 0; c < 3; ++c)
      if (v != 3) mean[c] += std::log(double(exposure(v)[c])) / kViews;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(std::log(found[3][c]), -mean[c], 0.01);
}

TEST(Exposures, OfTheCamerasNotesAreKeptWhereThePhotographsShowThem) {
  TrialOptions o = brief_trials();
  o.steps = 200;
  o.align = false;
  for (int v = 0; v < kViews; ++v) o.exposures.push_back(exposure(v));
  Progress quiet;
  PixelStore exposed = exposed_photographs(), equal = photographs(0);
  choose_start(make_device(), exposed, o, 1, quiet);
  EXPECT_EQ(exposure_change(exposed.exposures(), o.exposures), 0);
  choose_start(make_device(), equal, o, 1, quiet);
  EXPECT_TRUE(equal.exposures().empty());
}

TEST(AlignViews, CamerasThatAreRightStay) {
  PixelStore store = photographs(0);
  const std::vector<Camera> before = store.cameras();
  TrialOptions o = brief_trials();
  o.steps = 200;
  Progress quiet;
  choose_start(make_device(), store, o, 1, quiet);
  EXPECT_TRUE(same_cameras(store.cameras(), before));
}

TEST(AlignViews, TrialsOfTheHullAloneMoveCamerasIfThereIsTime) {
  PixelStore store = photographs(0.03);
  const std::vector<Camera> given = store.cameras();
  const double before = off_by(store);
  TrialOptions o = brief_trials();
  o.hull_alone = true;
  o.steps = 200;
  double now = 0;
  o.clock = [&] { return now += 1; };
  o.align_seconds = 0.5;  // over before the first
  Progress quiet;
  choose_start(make_device(), store, o, 1, quiet);
  EXPECT_TRUE(same_cameras(store.cameras(), given));
  o.align_seconds = 5;  // over after the second
  choose_start(make_device(), store, o, 1, quiet);
  EXPECT_LT(off_by(store), 0.7 * before) << before;  // by a model of 96 pixels and 200 steps
}

TEST(RefinedCameras, GoToTheCaptureAndBack) {
  Capture capture;
  std::vector<Camera> given, cameras;
  for (int v = 0; v < 4; ++v) {
    View view;
    view.name = std::to_string(v);
    view.split = v == 1 ? Split::test : Split::train;
    view.camera = true_camera(v);
    capture.views.push_back(view);
    if (v == 1) continue;
    given.push_back(true_camera(v));
    cameras.push_back(zoomed(moved(true_camera(v), disturbance(v, 0.01)), 1.03));
  }
  const Normalization n{{1, -2, 0.5}, 0.3};
  const RefinedCameras found = refined_cameras(capture, given, cameras, n);
  ASSERT_EQ(found.poses.size(), 3u);
  EXPECT_EQ(found.poses[1].view, "2");
  EXPECT_NEAR(found.focal, 1.03, 1e-12);
  EXPECT_EQ(refined_cameras(capture, given, given, n).focal, 1);
  const std::vector<Camera> back = refined(given, found, n);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(length(back[i].center - cameras[i].center), 1e-12);
    EXPECT_NEAR(back[i].fx, cameras[i].fx, 1e-9);
  }
  const Capture posed = with_cameras(capture, found);
  EXPECT_EQ(posed.views[1].camera.center.x, capture.views[1].camera.center.x);  // of the held-out view
  EXPECT_EQ(posed.views[1].camera.fx, found.focal * capture.views[1].camera.fx);
  EXPECT_LT(length(posed.views[3].camera.center - n.capture_from_unit(cameras[2].center)), 1e-12);
}

// A run goes on with what it stores; whoever resumes it starts from the given cameras.
TEST(RefinedCameras, AreThoseOfAResumedRun) {
  const BoxCapture box;
  Progress quiet;
  TrainingViews views = load_training_views(box.capture(), box, {}, quiet), again = views;
  std::vector<Camera> cameras = views.train.cameras();
  for (int round = 0; round < 3; ++round) {
    for (size_t v = 0; v < cameras.size(); ++v)
      cameras[v] = zoomed(moved(cameras[v], disturbance(int(v), 0.01)), 1.007);
    const RefinedCameras found = refined_cameras(box.capture(), views.given_train, cameras, {});
    views.set_cameras(found, {});
    cameras = views.train.cameras();
    again.set_cameras(found, {});
    EXPECT_TRUE(same_cameras(cameras, again.train.cameras())) << round;
    EXPECT_NEAR(found.focal, std::pow(1.007, round + 1), 1e-12);
  }
  ASSERT_FALSE(views.held_out.cameras().empty());
  EXPECT_NEAR(views.held_out.cameras()[0].fx, std::pow(1.007, 3) * views.given_held_out[0].fx, 1e-9);
}

}  // namespace
}  // namespace cei3d

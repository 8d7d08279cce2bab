// SPDX-License-Identifier: Apache-2.0
// For tests: a reconstruction small enough to be run many times, on a clock that the test owns.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/rotation.h"
#include "engine/reconstruct/reconstruct_with.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {

// Pictures that a test has drawn, in place of photographs.
class DrawnCapture : public ImageSource {
 public:
  Image load(const View& view) const override { return pictures_.at(view.name); }
  const Capture& capture() const { return capture_; }

 protected:
  // Every sixth view is held out.
  void add(const Camera& camera, Image picture) {
    const size_t index = capture_.views.size();
    View view;
    view.name = std::to_string(index);
    view.split = index % 6 == 5 ? Split::test : Split::train;
    view.camera = camera;
    pictures_[view.name] = std::move(picture);
    capture_.views.push_back(view);
  }

 private:
  std::map<std::string, Image> pictures_;
  Capture capture_;
};

// The box from all around, checkered so that stereo and albedo have something to find.
class BoxCapture : public DrawnCapture {
 public:
  explicit BoxCapture(int views = 12, int size = 28) {
    for (int v = 0; v < views; ++v) {
      const Camera camera = box_camera(-0.5 + 1.3 * v / views, 2.4 * v, size);
      add(camera, box_picture(camera, [](Vec3f p) {
            const bool odd =
                (int(std::floor(p.x * 7)) + int(std::floor(p.y * 7)) + int(std::floor(p.z * 7))) & 1;
            return (odd ? Vec3f{0.5f, 0.3f, 0.2f} : Vec3f{0.2f, 0.3f, 0.4f}) * (1 + 0.3f * p.z);
          }));
    }
  }
};

// The box in photographs that are brighter and darker in turn.
class ExposedCapture : public BoxCapture {
 public:
  using BoxCapture::BoxCapture;
  static float factor(const std::string& view) { return std::stoi(view) % 2 ? 0.6f : 1.3f; }
  Image load(const View& view) const override {
    Image image = BoxCapture::load(view);
    for (size_t i = 0; i < image.data.size(); ++i)
      if (i % 4 < 3) image.data[i] *= factor(view.name);
    return image;
  }
};

// The same box, of matte stone below and of polished metal above, on a turntable under fixed lamps.
class TurntableCapture : public DrawnCapture {
 public:
  explicit TurntableCapture(int views = 12, int size = 32) {
    for (int v = 0; v < views; ++v) {
      const Camera camera = box_camera(-0.5 + 1.3 * v / views, 2.4 * v, size);
      const Vec3f eye = to_float(camera.center);
      const Mat3f room = about_axis({0, 0, 1}, -std::atan2(eye.y, eye.x));
      add(camera, box_picture(camera, [&](Vec3f p) {
            const Vec3f n = pit_box().normal(p), d = normalize(p - eye), r = d - n * (2 * dot(d, n));
            return p.z > 0 ? Vec3f{1, 0.75f, 0.4f} * lamps(room * r, 6) : stone(p) * lamps(room * n, 1);
          }));
    }
  }

 private:
  // sharpness: of the lobes of two lamps.
  static Vec3f lamps(Vec3f direction, float sharpness) {
    const auto lamp = [&](Vec3f at) { return std::exp(sharpness * (dot(direction, normalize(at)) - 1)); };
    return Vec3f{0.1f, 0.1f, 0.1f} + Vec3f{0.6f, 0.6f, 0.5f} * lamp({1, 0.3f, 0.5f}) +
           Vec3f{0.2f, 0.3f, 0.5f} * lamp({-0.5f, 1, 0.2f});
  }
  static Vec3f stone(Vec3f p) {
    const bool odd = (int(std::floor(p.x * 7)) + int(std::floor(p.y * 7))) & 1;
    return odd ? Vec3f{0.5f, 0.3f, 0.2f} : Vec3f{0.2f, 0.3f, 0.4f};
  }
};

inline void shrink_networks(Preset& p) {
  const auto shrink = [](FieldConfig& f) {
    EncodingConfig& e = f.encoding;
    e.frequencies = std::min(e.frequencies, 3);
    e.levels = std::min(e.levels, 4);
    e.base_resolution = 8;
    e.finest_resolution = 24;
    e.log2_table = 10;
    f.width = 24;
  };
  for (GeometryOptions* g : {&p.geometry, &p.trial.geometry}) {
    shrink(g->sdf);
    g->sdf.outputs = 5;
    g->radiance_width = 16;
    g->rays = 128;
    g->prefit_steps = 40;
  }
  shrink(p.appearance.albedo);
}

// The preset's networks, schedules and grids, each as small as it still works.
inline Preset shrunken(Preset p) {
  const bool has_finer_mesh = p.resolution_from_views;
  shrink_networks(p);
  p.appearance.batch = p.polish.batch = 64;
  p.appearance.albedo_steps = 6;
  p.appearance.refine_steps = 28;  // two refreshes of the bounce
  p.appearance.lobe_steps = 20;
  p.appearance.roughness = 0.3f;
  p.trial.shapes.cells = p.trial.shapes.stereo_cells = 32;
  p.trial.shapes.carving.steps = 20;
  p.trial.shapes.carving.rays = 1024;
  p.trial.steps = 3;
  p.trial.rays = 128;
  p.meshing.resolution = 24;
  p.finer_meshing.resolution = has_finer_mesh ? 36 : 24;
  p.resolution_from_views = false;
  p.max_hits = 2500;
  p.brief_hits = 2000;
  p.max_residual_hits = p.max_residual_pixels = 2000;
  p.polish_steps = 8;
  p.joint_steps = 8;
  p.joint.rays = 64;
  p.joint.box_points = p.joint.near_points = p.joint.mask_rays = 32;
  p.joint.refresh = 3;
  p.residual_steps = 12;
  p.refinement_steps = 4;
  return p;
}

// Seconds pass with every look at the clock and at no other time.
class VirtualClock {
 public:
  explicit VirtualClock(double tick) : tick_(tick) {}
  Clock clock() {
    return [this] { return seconds_ += tick_; };
  }
  double seconds() const { return seconds_; }

 private:
  double tick_, seconds_ = 0;
};

class MemoryCheckpoints : public Checkpoints {
 public:
  void save(const State& s) override {
    latest_state = s;
    const std::string stage = s.head.at("stage").get<std::string>();
    if (s.head.at("finished").get<bool>())
      after[stage] = s;
    else
      ++midway[stage];
  }
  std::optional<State> latest() override { return latest_state; }

  std::optional<State> latest_state;
  std::map<std::string, State> after;  // the state after each stage
  std::map<std::string, int> midway;   // how many states were saved in the middle of each stage
};

struct Killed : std::runtime_error {
  Killed() : std::runtime_error("killed") {}
};

// Killed as soon as the stage has saved itself `saves` times in its middle.
class KilledAfterSaves : public MemoryCheckpoints {
 public:
  KilledAfterSaves(State from, std::string stage, int saves) : stage_(std::move(stage)), saves_(saves) {
    latest_state = std::move(from);
  }
  void save(const State& s) override {
    MemoryCheckpoints::save(s);
    if (midway[stage_] == saves_) throw Killed();
  }

 private:
  std::string stage_;
  int saves_;
};

// Notes the stages, counts the checks in each, and stops the run at one of them.
class ScriptedProgress : public Progress {
 public:
  enum class How { cancel, kill };  // kill: nothing can be saved any more

  void stop_at(std::string stage, int check, How how = How::cancel) {
    stage_to_stop_ = std::move(stage);
    check_to_stop_ = check;
    how_ = how;
  }

  void on_report(const ProgressReport& r) override {
    const std::lock_guard lock(mutex_);
    if (stages.empty() || stages.back() != r.stage) stages.push_back(r.stage);
    fractions.push_back(r.fraction);
  }
  void on_log(const std::string& line) override {
    const std::lock_guard lock(mutex_);
    lines.push_back(Json::parse(line));
  }
  bool is_cancelled() const override {
    const std::lock_guard lock(mutex_);
    const std::string stage = stages.empty() ? "" : stages.back();
    const int check = ++checks[stage];
    if (stage == stage_to_stop_ && check >= check_to_stop_) stopped_ = true;
    if (stopped_ && how_ == How::kill) throw Killed();
    return stopped_;
  }

  int all_checks() const {
    const std::lock_guard lock(mutex_);
    int all = 0;
    for (const auto& [stage, count] : checks) all += count;
    return all;
  }

  std::vector<std::string> stages;
  std::vector<double> fractions;
  std::vector<Json> lines;
  mutable std::map<std::string, int> checks;

 private:
  mutable std::mutex mutex_;
  std::string stage_to_stop_ = "no stage";
  int check_to_stop_ = 0;
  How how_ = How::cancel;
  mutable bool stopped_ = false;
};

inline void expect_same(const Tensors& a, const Tensors& b, const std::string& where) {
  ASSERT_EQ(a.size(), b.size()) << where;
  for (const auto& [name, tensor] : a) {
    ASSERT_TRUE(b.contains(name)) << where << " " << name;
    EXPECT_EQ(tensor.shape, b.at(name).shape) << where << " " << name;
    EXPECT_TRUE(tensor.f32 == b.at(name).f32 && tensor.u8 == b.at(name).u8) << where << " " << name;
  }
}

}  // namespace cei3d

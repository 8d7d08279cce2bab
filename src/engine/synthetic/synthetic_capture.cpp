// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/synthetic_capture.h"

#include <algorithm>
#include <chrono>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/io/image_file.h"
#include "engine/io/ply.h"
#include "engine/synthetic/body_mesh.h"
#include "engine/synthetic/names.h"
#include "engine/synthetic/synthetic_meta.h"
#include "engine/synthetic/truth_files.h"
#include "engine/synthetic/views.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr int kMapHeight = 256, kMeshCells = 192;
constexpr uint64_t kTestSeed = 1000000, kRelitSeed = 2000000;  // added to a view's number

void require_free(const fs::path& folder) {
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    fail_usage("{} exists already; name another folder, or delete it.", folder.string());
}

std::vector<std::string> other_lights(const std::string& light) {
  std::vector<std::string> names = light_names();
  std::erase(names, light);
  return names;
}

class CaptureWriter {
 public:
  CaptureWriter(const SynthRequest& request, Progress& progress)
      : request_(request),
        progress_(progress),
        scene_(scene_of(request)),
        relight_(other_lights(request.light)),
        train_(spread_cameras(request.views, lens_of_size(request.width, request.height))),
        test_(spiral_cameras(request.test_views, lens_of_size(request.width, request.height))),
        views_(train_.size() + test_.size() + relight_.size() * ((test_.size() + 1) / 2)) {}

  SynthReport write() {
    write_descriptions();
    for (size_t i = 0; i < train_.size(); ++i) write_training_view(i);
    for (size_t i = 0; i < test_.size(); ++i) write_test_view(i);
    for (const std::string& light : relight_)
      for (size_t i = 0; i < test_.size(); i += 2) write_relit_view(light, i);
    return {request_.out, int(train_.size()), int(test_.size()), int(views_ - train_.size() - test_.size()),
            seconds()};
  }

 private:
  const fs::path& out() const { return request_.out; }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  void write_descriptions() {
    const auto write_cameras =
        request_.layout == SynthLayout::physg ? write_physg_cameras : write_nerf_cameras;
    write_cameras(out(), "train", train_);
    if (!test_.empty()) write_cameras(out(), "test", test_);
    write_ply(out() / "mesh_gt.ply", body_mesh(*scene_.shape.body, kMeshCells));
    write_hdr(out() / "envs" / (request_.light + ".hdr"), lat_long(scene_.light, kMapHeight));
    for (const std::string& name : relight_)
      write_hdr(out() / "envs" / (name + ".hdr"), lat_long(light_by_name(name), kMapHeight));
    write_file_atomic(out() / "meta.json", capture_meta(request_, scene_, relight_).dump(1) + "\n");
  }

  TrueView view(const Camera& camera, const SgMixture& light, uint64_t number) {
    check_cancelled(progress_, "Interrupted; the images written so far are complete.");
    const double done = double(drawn_) / double(views_);
    progress_.report({"drawing", done, drawn_ == 0 ? -1 : seconds() * (1 - done) / done,
                      fmt::format("view {} of {}", drawn_ + 1, views_)});
    ++drawn_;
    SyntheticScene lit = scene_;
    lit.light = light;
    return draw(lit, camera, {request_.samples, request_.seed, number});
  }
  SgMixture training_light(const Camera& camera) const {
    return request_.light_turns ? turned_with(scene_.light, camera.center) : scene_.light;
  }

  void write_photograph(const char* split, size_t i, const Image& linear_rgba) {
    if (request_.layout == SynthLayout::physg)
      write_radiance(out() / split, view_stem(i), linear_rgba);
    else
      write_color(out() / split / (view_stem(i) + ".png"), linear_rgba);
  }
  void write_training_view(size_t i) {
    const TrueView v = view(train_[i], training_light(train_[i]), i);
    write_photograph("train", i, with_noise(v.color, request_.noise, request_.seed, i));
  }
  void write_test_view(size_t i) {
    const TrueView v = view(test_[i], training_light(test_[i]), kTestSeed + i);
    write_photograph("test", i, v.color);
    write_truth(out(), view_stem(i), v);
  }
  void write_relit_view(const std::string& light, size_t i) {
    const TrueView v = view(test_[i], light_by_name(light), kRelitSeed + i);
    write_color(out() / "edits" / "relight" / light / (view_stem(i) + ".png"), v.color);
  }

  const SynthRequest& request_;
  Progress& progress_;
  SyntheticScene scene_;
  std::vector<std::string> relight_;
  std::vector<Camera> train_, test_;
  size_t views_, drawn_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void set_region(const RegionFinish& r, const Shape& shape, std::vector<Finish>& finishes) {
  const auto at = std::find(shape.regions.begin(), shape.regions.end(), r.region);
  if (at == shape.regions.end())
    fail_usage("A {} has no region '{}'; it has {}.", shape.name, r.region, listed(shape.regions));
  finishes[size_t(at - shape.regions.begin())] = r.finish;
}

}  // namespace

Json SynthReport::json() const {
  return {{"out", out.string()},
          {"views", views},
          {"test_views", test_views},
          {"relit_views", relit_views},
          {"seconds", seconds}};
}

SyntheticScene scene_of(const SynthRequest& r) {
  SyntheticScene s;
  s.shape = shape_by_name(r.shape);
  s.finishes = finish_set(r.material, s.shape.regions);
  for (const RegionFinish& region : r.regions) set_region(region, s.shape, s.finishes);
  for (size_t i = 0; i < s.finishes.size(); ++i) {
    if (r.roughness) s.finishes[i].material.roughness = *r.roughness;
    require_valid(s.finishes[i], s.shape.regions[i]);
  }
  s.light = scaled(light_by_name(r.light), r.light_tint * r.light_strength);
  s.diffuse = r.diffuse;
  s.bounces = r.bounces;
  return s;
}

SynthReport make_capture(const SynthRequest& request, Progress& progress) {
  require_free(request.out);
  return CaptureWriter(request, progress).write();
}

}  // namespace cei3d

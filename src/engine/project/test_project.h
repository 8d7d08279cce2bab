// SPDX-License-Identifier: Apache-2.0
// A small project in a folder of its own, for tests.
#pragma once

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "core/math/rng.h"
#include "engine/project/project.h"

namespace cei3d {

namespace fs = std::filesystem;

template <class F>
std::string message_of(F run) {
  try {
    run();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

inline Capture small_capture(const fs::path& root) {
  Capture c;
  c.root = root;
  c.format = "nerf-synthetic";
  for (int i = 0; i < 3; ++i) {
    View v;
    v.name = "train/r_00" + std::to_string(i);
    v.camera.width = 8;
    v.camera.height = 6;
    v.camera.fx = v.camera.fy = 11.5 + i;
    v.camera.cx = 4.25;
    v.camera.cy = 3;
    v.camera.center = {0.1 * i, 1.0 / 3, -4};
    v.image_path = root / (v.name + ".png");
    c.views.push_back(v);
  }
  c.views.back().split = Split::test;
  c.views.back().name = "test/r_002";
  return c;
}

inline std::shared_ptr<const Field> small_field(int outputs, uint64_t seed) {
  FieldConfig c;
  c.encoding.levels = 2;
  c.encoding.base_resolution = 4;
  c.encoding.finest_resolution = 8;
  c.encoding.log2_table = 6;
  c.width = 32;
  c.outputs = outputs;
  c.output_activation = Activation::sigmoid;
  return std::make_shared<Field>(c, seed);
}

inline Scene small_scene() {
  Scene s;
  s.normalization = {{0.25, -1, 1.0 / 3}, 0.7};
  s.up = {0, 1, 0};
  s.sdf = small_field(1, 1);
  s.albedo = small_field(3, 2);
  s.light.lobes = {{{0, 0, 1}, 3.5f, {1, 2, 3}}, {{1, 0, 0}, 20, {0.5f, 0, 0.25f}}};
  s.material = Material{0.21f, 0.4f, 1};
  auto points = std::make_shared<HandlerPoints>();
  points->positions = {{0, 0, 0.5f}, {0.5f, 0, 0}};
  points->normals = {{0, 0, 1}, {1, 0, 0}};
  points->footprints = {0.01f, 0.02f};
  points->spacing = 0.03f;
  s.handlers = points;
  return s;
}

inline EditLayer small_layer(const std::string& id, uint64_t seed) {
  EditLayer layer;
  layer.id = id;
  Rng rng(seed, 0, 0);
  layer.region = Region({{{rng.uniform(), 0, 0.5f}}, {{0, 0, 1}}, {0.1f}, {}});
  layer.albedo = small_field(3, seed);
  return layer;
}

// Scene as bytes: equal bytes, equal scenes.
inline std::string bytes_of(const Scene& scene) {
  Tensors tensors;
  Json head = Json::object();
  save_scene(scene, tensors, head);
  std::string bytes = tensors_to_bytes(tensors) + head.dump();
  for (const EditLayer& layer : scene.layers) {
    Tensors t;
    Json h = Json::object();
    save_layer(layer, t, h);
    bytes += tensors_to_bytes(t) + h.dump();
  }
  return bytes;
}

inline EditRecord paint_record(const Project& project) {
  EditRecord r;
  r.op = "paint";
  r.id = project.stack().next_id(r.op);
  r.params = {{"view", "train/r_000"}, {"seed", 1}};
  r.report = {{"points", 1}};
  r.inputs = {{"scribble.png", "not really a picture"}};
  return r;
}

inline void add_paint(Project& project, uint64_t seed) {
  const EditRecord r = paint_record(project);
  project.add_edit(r, small_layer(r.id, seed));
}

inline std::vector<fs::path> files_below(const fs::path& folder, const std::string& suffix) {
  std::vector<fs::path> found;
  for (const auto& e : fs::recursive_directory_iterator(folder))
    if (e.is_regular_file() && e.path().string().ends_with(suffix)) found.push_back(e.path());
  return found;
}

class ProjectTest : public ::testing::Test {
 protected:
  fs::path folder() const { return temp_.path() / "object"; }
  Project make(bool replace = false) {
    return Project::create(folder(), {{{1, 2, 3}, 0.5}, {{"preset", "fast"}}},
                           small_capture(temp_.path() / "photos"), replace);
  }
  Project make_with_base() {
    Project p = make();
    p.save_base(small_scene());
    return p;
  }
  TempFolder temp_;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// For tests of edits: a project that holds a sphere, and commands on it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"
#include "engine/session/session.h"

namespace cei3d {

inline constexpr int kSize = 48;

inline Capture three_views() {
  Capture c;
  c.root = "/nowhere";
  c.format = "nerf-synthetic";
  for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{2, 2, 1}, Vec3d{-2, 1, -1}}) {
    View v;
    v.name = "train/r_" + std::to_string(c.views.size());
    v.camera = camera_towards_origin(center, kSize);
    c.views.push_back(v);
  }
  return c;
}

// Opaque in a square about the middle.
inline Image square_scribble(Vec3f srgb, int half) {
  Image s(kSize, kSize, 4);
  for (int y = kSize / 2 - half; y < kSize / 2 + half; ++y)
    for (int x = kSize / 2 - half; x < kSize / 2 + half; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = srgb[c];
      s.at(x, y)[3] = 1;
    }
  return s;
}

inline Region ball(Vec3f center, float radius) {
  return Region({{center}, {normalize(center)}, {radius}, {}});
}

// What an edit leaves: the scene but for the names of its layers.
inline std::string bytes_of(const Scene& scene) {
  std::string bytes;
  const auto add = [&](const Tensors& t, const Json& h) { bytes += tensors_to_bytes(t) + h.dump(); };
  Tensors base;
  Json head = Json::object();
  save_scene(scene, base, head);
  add(base, head);
  for (EditLayer layer : scene.layers) {
    layer.id = "";
    Tensors t;
    Json h = Json::object();
    save_layer(layer, t, h);
    add(t, h);
  }
  return bytes;
}

inline std::string files_of(const std::filesystem::path& folder) {
  std::string list = read_file(folder / "stack.json");
  std::vector<std::string> files;
  for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
    files.push_back(e.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string& f : files) list += f + "\n";
  return list;
}

class EditTest : public ::testing::Test {
 protected:
  void SetUp() override { make("a"); }
  std::filesystem::path folder(const std::string& name) const { return temp_.path() / name; }
  void make(const std::string& name) {
    Project::create(folder(name), {}, three_views(), false).save_base(sphere_with_handlers());
    session_.open(folder(name), Session::Access::write);
  }
  Scene scene(const std::string& name) { return Project::open(folder(name), Project::Mode::read).scene(); }
  // As `edit part` will do it.
  void add_part(const std::string& name, Vec3f center, float radius) {
    session_.close();
    {
      Project p = Project::open(folder("a"), Project::Mode::write);
      EditLayer layer;
      layer.id = p.stack().next_id("part");
      layer.region = ball(center, radius);
      layer.part = name;
      p.add_edit({layer.id, "part", 1, Json::object(), {}, Json::object(), {}}, layer);
    }
    session_.open(folder("a"), Session::Access::write);
  }
  PaintCommand scribble(int view, Vec3f srgb, int half) {
    const std::filesystem::path file = temp_.path() / "scribble.png";
    write_png(file, square_scribble(srgb, half));
    return {{{"train/r_" + std::to_string(view), file}}};
  }

  TempFolder temp_;
  Session session_;
  Progress quiet_;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: the files of a project, and the arrays and meshes in it and beside it. The first byte of
// the input chooses what the rest is. Anything but an object or an Error is a finding.
#include <string>
#include <vector>

#include "core/base/file.h"
#include "core/base/hash.h"
#include "engine/io/npy.h"
#include "engine/io/ply.h"
#include "engine/io/zip_file.h"
#include "engine/project/project.h"
#include "engine/project/test_project.h"
#include "tests/fuzz/target.h"

namespace {
namespace fs = std::filesystem;
using cei3d::Json;

// A project with an object, a training state and two edits, of which each input replaces one file.
class Victim {
 public:
  Victim() {
    using cei3d::Project;
    Project p = Project::create(folder(), {{{1, 2, 3}, 0.5}, {{"preset", "fast"}}},
                                cei3d::small_capture(temp_.path() / "photos"), false);
    p.save_checkpoint({{{"stage", "geometry"}}, {}});
    p.save_base(cei3d::small_scene());
    cei3d::add_paint(p, 1);
    cei3d::add_paint(p, 2);
    cei3d::save_scene(cei3d::small_scene(), scene_, scene_head_);
    cei3d::save_layer(cei3d::small_layer("0001-paint", 1), layer_, layer_head_);
  }
  fs::path folder() const { return temp_.path() / "object"; }
  const Json& scene_head() const { return scene_head_; }
  const Json& layer_head() const { return layer_head_; }

  void open_with(const std::string& file, const std::string& bytes) {
    const std::string before = cei3d::read_file(folder() / file);
    cei3d::write_file_atomic(folder() / file, bytes);
    try {
      use();
    } catch (const cei3d::Error&) {
    }
    cei3d::write_file_atomic(folder() / file, before);
  }
  // A scene whose head is the input, with the tensors of a good one.
  void open_with_head(const std::string& bytes) {
    const Json head = Json::parse(bytes, nullptr, false);
    cei3d::load_scene(scene_, head, "input");
  }

 private:
  void use() {
    const auto p = cei3d::Project::open(folder(), cei3d::Project::Mode::read);
    p.latest_checkpoint();
    p.scene();
    cei3d::Stack stack = p.stack();
    for (const std::string& id : stack.all_ids()) p.edit(id), p.edit_inputs(id);
    p.first_stale(stack);
  }

  cei3d::TempFolder temp_;
  cei3d::Tensors scene_, layer_;
  Json scene_head_ = Json::object(), layer_head_ = Json::object();
};

void read_as(int kind, const std::string& bytes) {
  static Victim victim;
  static const char* const kFiles[] = {
      "project.json",         "stack.json", "dataset.json", "base/scene.json", "edits/0001-paint/edit.json",
      "base/000001.ckpt.json"};
  switch (kind) {
    case 6:
      cei3d::load_scene(cei3d::tensors_from_bytes(bytes, "input"), victim.scene_head(), "input");
      return;
    case 7:
      cei3d::load_layer(cei3d::tensors_from_bytes(bytes, "input"), victim.layer_head(), "input");
      return;
    case 8:
      victim.open_with_head(bytes);
      return;
    case 9:
      cei3d::decode_ply(bytes, "input");
      return;
    case 10: {
      const cei3d::NpyArray lobes = cei3d::decode_npy(bytes, "input");
      if (lobes.shape.size() == 2 && lobes.shape[1] == 7) cei3d::light_from_array(lobes.floats());
      return;
    }
    case 11:
      for (const auto& [name, file] : cei3d::unzip(bytes, "input", 1 << 20)) cei3d::decode_npy(file, name);
      return;
    default:
      victim.open_with(kFiles[kind], bytes);
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzz_kinds(data, size, 12, read_as);
}

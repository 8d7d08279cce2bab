// SPDX-License-Identifier: Apache-2.0
// Makes the stored project of the present format, one of those that tests/e2e/stored.sh opens: disabled,
// since each is to stay as the program of its day stored it. Run when kProjectVersion is raised.
#include <gtest/gtest.h>

#include "core/base/json.h"
#include "core/base/test_source.h"
#include "core/math/rng.h"
#include "engine/project/project.h"
#include "engine/reconstruct/test_run.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;

const fs::path kStored = source_file("tests/e2e/data/formats") / std::to_string(kProjectVersion);

Scene reconstructed(const TurntableCapture& capture) {
  ReconstructOptions options;
  options.iterations = 400;
  options.light = LightMotion::turntable;
  Preset preset = shrunken(preset_by_name("fast"));
  preset.polish_from_iterations = 1;
  preset.appearance.roughness = 0;
  preset.max_hits = preset.max_residual_hits = 8000;
  preset.brief_hits = 4000;
  preset.appearance.materials = preset.appearance.albedo;
  preset.appearance.materials.outputs = MaterialField::kOutputs;
  preset.appearance.albedo_steps = preset.residual_steps = 300;
  preset.finer_meshing = preset.meshing;
  MemoryCheckpoints checkpoints;
  Progress quiet;
  return reconstruct({.device = make_device(),
                      .capture = capture.capture(),
                      .images = capture,
                      .normalization = {},
                      .options = options,
                      .preset = preset},
                     checkpoints, quiet);
}

FieldConfig small_field(int outputs) {
  FieldConfig config;
  config.encoding = {0, 2, 4, 8, 6};
  config.width = 32;
  config.outputs = outputs;
  config.output_activation = Activation::sigmoid;
  return config;
}

// Of the sphere's upper part, from above.
ResidualImage some_image() {
  Camera camera;
  camera.width = camera.height = 8;
  camera.fx = camera.fy = 20;
  camera.cx = camera.cy = 4;
  camera.center = {0, 0, 3};
  camera.world_from_cam = upright_rotation({0, 0, -1}, {0, 1, 0});
  std::vector<std::array<uint16_t, 2>> pixels;
  for (uint16_t i = 0; i < 64; ++i) pixels.push_back({uint16_t(i % 8), uint16_t(i / 8)});
  return ResidualImage(camera, pixels, std::vector<Vec3f>(64, {0.1f, 0, -0.1f}),
                       std::vector<float>(64, 2.6f));
}

// Corrections that can be seen, whether or not a reconstruction would keep any.
std::shared_ptr<const Residual> some_residual(const Scene& scene) {
  Residual residual = make_residual(scene.sdf, 3);
  Param& last = residual.params.all()[residual.params.all().size() - 2];  // zero to start with
  for (size_t i = 0; i < last.count(); ++i) last.value[i] = 0.05f * Rng(5, 5, i).normal();
  residual.images = std::make_shared<const ResidualImages>(std::vector{some_image()});
  return std::make_shared<const Residual>(std::move(residual));
}

// A layer of paint with a network much smaller than those that learn a scribble.
void add_small_paint(const fs::path& folder) {
  Project project = Project::open(folder, Project::Mode::write);
  EditLayer layer;
  layer.id = project.stack().next_id("paint");
  layer.region = Region({{{0, 0, -0.4f}}, {{0, 0, -1}}, {0.3f}, {}});
  layer.albedo = std::make_shared<Field>(small_field(3), 5);
  project.add_edit({layer.id, "paint", 1, Json::object(), {}, Json::object(), {}}, layer);
}

void add_edits(Session& session) {
  Progress quiet;
  MaterialCommand rough;
  rough.effects.roughness = 0.4;
  session.change_material(rough, quiet);
  PartCommand part;
  part.view = "0";
  part.positive = {{20.5, 20.5}};
  part.name = "side";
  part.effects.color = "#4060a0";
  session.select_part(part, quiet);
  session.deform({PixelDrag{"0", {20.5, 20.5}, {2, 0}}, 0.3, ""}, quiet);
  LightChoice light;
  light.rotate_degrees = 40;
  light.scale = 1.2;
  session.change_light(light, quiet);
}

// An edit that is undone, one that it set aside, and a name.
void add_history(Session& session) {
  Progress quiet;
  MaterialCommand smooth;
  smooth.effects.roughness = 0.1;
  const std::string displaced = session.change_material(smooth, quiet).id;
  session.undo(quiet);
  smooth.effects.roughness = 0.2;
  session.change_material(smooth, quiet);
  session.undo(quiet);
  session.rename("0001-paint", "stripe");
  EXPECT_EQ(displaced, "0006-material");
}

void render_into(Session& session, const std::string& name) {
  Progress quiet;
  const fs::path out = fs::temp_directory_path() / ("stored-" + name);
  RenderRequest request;
  request.out = out;
  request.channels = {Channel::rgb, Channel::albedo, Channel::normal, Channel::roughness};
  session.render(request, quiet);
  for (const Channel c : request.channels)
    fs::copy(out / channel_name(c), kStored / name / channel_name(c), fs::copy_options::recursive);
  fs::remove_all(out);
}

TEST(StoredProject, DISABLED_IsMade) {
  fs::remove_all(kStored);
  fs::create_directories(kStored);
  fs::create_directories(kStored / "plain");
  fs::create_directories(kStored / "edited");
  const TurntableCapture images(24, 48);
  Capture capture = images.capture();
  capture.root = "/nowhere";
  capture.format = "nerf-synthetic";
  Scene scene = reconstructed(images);
  // Some that vary: what is stored is tested here, not what is found.
  scene.material = {scene.material.mean(),
                    std::make_shared<const Field>(small_field(MaterialField::kOutputs), 6)};
  EXPECT_EQ(scene.light_frame.motion, LightMotion::turntable);
  scene.residual = some_residual(scene);
  const fs::path folder = kStored / "project";
  Project::create(folder, {}, capture, false).save_base(scene);
  Session session;
  session.open(folder, Session::Access::read);
  render_into(session, "plain");
  session.close();
  add_small_paint(folder);
  session.open(folder, Session::Access::write);
  add_edits(session);
  add_history(session);
  render_into(session, "edited");
  session.close();
  for (const char* name : {"cache", "runs", ".lock"}) fs::remove_all(folder / name);
}

}  // namespace
}  // namespace cei3d

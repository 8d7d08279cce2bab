// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene.h"

#include "core/base/json_reader.h"
#include "model/geometry/shape/carry.h"
#include "model/geometry/shape/vec_json.h"
#include "model/geometry/shape/vec_tensors.h"
#include "model/scene/stored.h"

namespace cei3d {
namespace {

void save_surface(const Surface& surface, Tensors& tensors, Json& head) {
  const Mesh& mesh = surface.mesh();
  head["surface"] = {{"vertices", mesh.positions.size()},
                     {"triangles", mesh.triangles.size()},
                     {"normals", !mesh.normals.empty()},
                     {"sky_directions", kSkyDirections}};
  tensors["surface/positions"] = tensor_of(mesh.positions);
  if (!mesh.normals.empty()) tensors["surface/normals"] = tensor_of(mesh.normals);
  tensors["surface/triangles"] = tensor_of(std::span(mesh.triangles));
  tensors["surface/visibility"] = {
      {int64_t(mesh.positions.size()), kSkyDirections / 8}, {}, surface.visibility()};
}

void check_triangles(const Mesh& mesh) {
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t)
      if (v >= mesh.positions.size())
        fail("A triangle of the stored surface names vertex {} of {}.", v, mesh.positions.size());
}

std::shared_ptr<const Surface> load_surface(const Tensors& tensors, JsonReader head) {
  if (const int directions = head.require<int>("sky_directions"); directions != kSkyDirections)
    fail("The stored surface has {} sky directions, this program uses {}. Reconstruct the object again.",
         directions, kSkyDirections);
  const int64_t vertices = rows_from(head.member("vertices")), faces = rows_from(head.member("triangles"));
  const bool has_normals = head.require<bool>("normals");
  head.finish();
  Mesh mesh;
  mesh.positions = vectors_from(tensors, "surface/positions", vertices);
  if (has_normals) mesh.normals = vectors_from(tensors, "surface/normals", vertices);
  mesh.triangles = triangles_from(tensors, "surface/triangles", faces);
  check_triangles(mesh);
  std::vector<uint8_t> visibility =
      require_bytes(tensors, "surface/visibility", {vertices, kSkyDirections / 8}).u8;
  return std::make_shared<Surface>(std::move(mesh), std::move(visibility));
}

void save_handlers(const HandlerPoints& points, Tensors& tensors, Json& head) {
  head["handlers"] = {{"points", points.positions.size()}, {"spacing", points.spacing}};
  tensors["handlers/positions"] = tensor_of(points.positions);
  tensors["handlers/normals"] = tensor_of(points.normals);
  tensors["handlers/footprints"] = {{int64_t(points.footprints.size()), 1}, points.footprints, {}};
}

std::shared_ptr<const HandlerPoints> load_handlers(const Tensors& tensors, JsonReader head) {
  const int64_t n = rows_from(head.member("points"));
  auto points = std::make_shared<HandlerPoints>();
  points->positions = vectors_from(tensors, "handlers/positions", n);
  points->normals = vectors_from(tensors, "handlers/normals", n);
  points->footprints = require_tensor(tensors, "handlers/footprints", {n, 1}).f32;
  points->spacing = head.require<float>("spacing");
  head.finish();
  return points;
}

void save_residual(const Residual& residual, const std::shared_ptr<const Field>& sdf, Tensors& tensors,
                   Json& head) {
  if (residual.images) save_residual_images(*residual.images, tensors, head);
  if (!residual.features) return;
  head["residual"] = {{"layers", residual.network.hidden_layers}};
  residual.params.save(tensors, "residual");
  if (residual.features != sdf) save_field(residual.features, "residual_features", tensors, head);
}

int layers_from(JsonReader head) {
  const int layers = head.require<int>("layers");
  head.finish();
  return layers;
}

Residual load_network(const Tensors& tensors, const std::shared_ptr<const Field>& sdf, JsonReader& reader) {
  // Objects of project version 2 have two layers over the SDF's own features.
  const int layers = reader.member("residual").is_object() ? layers_from(reader.object("residual")) : 2;
  if (layers < 1 || layers > kMaxResidualLayers) fail("The correction network has {} layers.", layers);
  const std::shared_ptr<const Field> own = load_field("residual_features", tensors, reader);
  Residual residual = make_residual(own ? own : sdf, 0, layers);
  residual.params.load(tensors, "residual");
  return residual;
}

std::shared_ptr<const Residual> load_residual(const Tensors& tensors, const std::shared_ptr<const Field>& sdf,
                                              JsonReader& reader) {
  const bool network = reader.has("residual"), images = reader.has("residual_images");
  if (!network && !images) return nullptr;
  Residual residual;
  if (network) residual = load_network(tensors, sdf, reader);
  if (images)
    residual.images = std::make_shared<const ResidualImages>(
        load_residual_images(tensors, reader.object("residual_images")));
  return std::make_shared<const Residual>(std::move(residual));
}

void save_light_frame(const LightFrame& frame, Json& head) {
  const auto& r = frame.reference.row;
  const Json reference = {r[0].x, r[0].y, r[0].z, r[1].x, r[1].y, r[1].z, r[2].x, r[2].y, r[2].z};
  head["light_frame"] = {{"motion", light_motion_name(frame.motion)},
                         {"axis", vector_json(frame.axis)},
                         {"reference", reference}};
  for (const CameraRing& ring : frame.rings)
    head["light_frame"]["rings"].push_back(
        {{"axis", vector_json(ring.axis)}, {"forward", ring.forward}, {"right", ring.right}});
}

CameraRing load_ring(JsonReader reader) {
  CameraRing ring{to_float(vector_from(reader, "axis")), reader.require<float>("forward"),
                  reader.require<float>("right")};
  reader.finish();
  return ring;
}

LightFrame load_light_frame(JsonReader& head) {
  JsonReader reader = head.object("light_frame");
  const auto motion = light_motion_named(reader.require<std::string>("motion"));
  if (!motion) fail("The motion of the light is unknown. Update cei3d.");
  LightFrame frame{*motion, to_float(vector_from(reader, "axis")), {}};
  const std::array<double, 9> rows = reader.numbers<9>("reference");  // row by row
  for (size_t i = 0; i < 3; ++i)
    frame.reference.row[i] = {float(rows[3 * i]), float(rows[3 * i + 1]), float(rows[3 * i + 2])};
  if (reader.has("rings"))
    for (const Json& j : reader.member("rings"))
      frame.rings.push_back(load_ring(JsonReader(j, reader.what() + ": a ring")));
  reader.finish();
  return frame;
}

Json poses_json(const std::vector<RefinedPose>& poses) {
  Json list = Json::array();
  for (const RefinedPose& p : poses) {
    const auto& r = p.world_from_cam.row;
    const Json rotation = {r[0].x, r[0].y, r[0].z, r[1].x, r[1].y, r[1].z, r[2].x, r[2].y, r[2].z};
    list.push_back({{"view", p.view}, {"world_from_cam", rotation}, {"center", vector_json(p.center)}});
  }
  return list;
}

Json exposures_json(const std::vector<ViewExposure>& exposures) {
  Json list = Json::array();
  for (const ViewExposure& e : exposures)
    list.push_back({{"view", e.view}, {"factors", vector_json(e.factors)}});
  return list;
}

ViewExposure exposure_from_json(JsonReader reader) {
  ViewExposure e{reader.require<std::string>("view"), to_float(vector_from(reader, "factors"))};
  reader.finish();
  return e;
}

RefinedPose pose_from_json(JsonReader reader) {
  RefinedPose p{reader.require<std::string>("view"), {}, vector_from(reader, "center")};
  const std::array<double, 9> rows = reader.numbers<9>("world_from_cam");  // row by row
  for (size_t i = 0; i < 3; ++i) p.world_from_cam.row[i] = {rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
  reader.finish();
  return p;
}

// Objects of project version 3 and below have one material.
std::shared_ptr<const Field> load_materials(const Tensors& tensors, JsonReader& head) {
  std::shared_ptr<const Field> field = load_field("materials", tensors, head);
  if (field && field->config().outputs < MaterialField::kOutputs)
    fail("The network of the materials has {} outputs, but {} are needed.", field->config().outputs,
         MaterialField::kOutputs);
  return field;
}

Scene reshaped(Scene scene, const Reshape& change, const std::shared_ptr<const Field>& sdf) {
  const std::shared_ptr<const Surface> before = scene.surface;
  if (!before) fail("The object has no surface that could be changed; reconstruct it again.");
  scene.shape_versions = with_version(std::move(scene.shape_versions), before, change, sdf);
  scene.surface = scene.shape_versions.back()->surface;
  if (scene.handlers)
    scene.handlers = std::make_shared<const HandlerPoints>(
        carried(*scene.handlers, before->mesh(), scene.surface->mesh(), change));
  return scene;
}

}  // namespace

Scene with_layer(Scene scene, EditLayer layer) {
  const int latest = scene.shape_versions.empty() ? 0 : int(scene.shape_versions.size()) - 1;
  if (layer.shape_version == kLatestVersion) layer.shape_version = latest;
  if (layer.shape_version < 0 || layer.shape_version > latest ||
      (layer.reshape && layer.shape_version != latest))
    fail("Edit {} was made for another shape of the object. Undo it, or make it again.", layer.id);
  if (layer.light) {
    scene.light = *layer.light;
    scene.light_frame = {};
    scene.light_error = {};
    scene.residual = nullptr;
  }
  if (layer.reshape) scene = reshaped(std::move(scene), *layer.reshape, layer.sdf);
  scene.layers.push_back(std::move(layer));
  return scene;
}

SgMixture light_in_view(const Scene& scene, const Camera& camera) {
  if (scene.light_frame.motion == LightMotion::world) return scene.light;
  return rotated(scene.light, transpose(scene.light_frame.room_from_object(camera.world_from_cam)));
}

Scene in_view(Scene scene, const Camera& camera) {
  if (scene.light_frame.motion == LightMotion::world) return scene;
  scene.light = light_in_view(scene, camera);
  if (scene.residual) {
    Residual residual = *scene.residual;
    residual.room_from_object = scene.light_frame.room_from_object(camera.world_from_cam);
    scene.residual = std::make_shared<const Residual>(std::move(residual));
  }
  return scene;
}

void save_scene(const Scene& scene, Tensors& tensors, Json& head) {
  head["center"] = vector_json(scene.normalization.center);
  head["scale"] = scene.normalization.scale;
  head["up"] = vector_json(scene.up);
  const Material& own = scene.material.mean();
  head["material"] = {{"roughness", own.roughness}, {"specular", own.specular}, {"metalness", own.metalness}};
  save_field(scene.sdf, "sdf", tensors, head);
  save_field(scene.albedo, "albedo", tensors, head);
  save_field(scene.material.varying(), "materials", tensors, head);
  if (scene.surface) save_surface(*scene.surface, tensors, head);
  save_light(scene.light, tensors, head);
  if (scene.light_error) head["light_error"] = vector_json(*scene.light_error);
  if (scene.light_frame.motion != LightMotion::world) save_light_frame(scene.light_frame, head);
  if (scene.residual) save_residual(*scene.residual, scene.sdf, tensors, head);
  if (scene.handlers) save_handlers(*scene.handlers, tensors, head);
  if (scene.explained)
    head["explained"] = {{"physical", scene.explained->physical},
                         {"with_residual", scene.explained->with_residual}};
  if (!scene.refined.poses.empty()) head["poses"] = poses_json(scene.refined.poses);
  if (scene.refined.focal != 1) head["focal"] = scene.refined.focal;
  if (!scene.exposures.empty()) head["exposures"] = exposures_json(scene.exposures);
}

RefinedCameras refined_from_head(const Json& head, const std::string& what) {
  RefinedCameras refined;
  if (head.contains("poses"))
    for (const Json& pose : head.at("poses"))
      refined.poses.push_back(pose_from_json({pose, what + ": a pose"}));
  if (head.contains("focal")) refined.focal = head.at("focal").get<double>();
  if (!(refined.focal > 0.1 && refined.focal < 10))
    fail("{} has the impossible factor {} on the focal length.", what, refined.focal);
  return refined;
}

Scene load_scene(const Tensors& tensors, const Json& head, const std::string& what) {
  return checked_load("object", [&] {
    JsonReader reader(head, what);
    Scene scene;
    scene.normalization.center = vector_from(reader, "center");
    scene.normalization.scale = reader.require<double>("scale");
    scene.up = vector_from(reader, "up");
    JsonReader material = reader.object("material");
    const Material mean{material.require<float>("roughness"), material.require<float>("specular"),
                        material.require<float>("metalness")};
    material.finish();
    scene.material = {mean, load_materials(tensors, reader)};
    scene.sdf = load_field("sdf", tensors, reader);
    scene.albedo = load_field("albedo", tensors, reader);
    if (reader.has("surface")) scene.surface = load_surface(tensors, reader.object("surface"));
    scene.light = load_light(tensors, reader.object("light"));
    if (reader.has("light_error")) scene.light_error = to_float(vector_from(reader, "light_error"));
    if (reader.has("light_frame")) scene.light_frame = load_light_frame(reader);
    scene.residual = load_residual(tensors, scene.sdf, reader);
    if (reader.has("handlers")) scene.handlers = load_handlers(tensors, reader.object("handlers"));
    if (reader.has("explained")) {
      JsonReader explained = reader.object("explained");
      scene.explained = {explained.require<double>("physical"), explained.require<double>("with_residual")};
      explained.finish();
    }
    for (const char* key : {"poses", "focal"}) reader.has(key);
    scene.refined = refined_from_head(head, what);
    if (reader.has("exposures"))
      for (const Json& e : head.at("exposures"))
        scene.exposures.push_back(exposure_from_json({e, "An exposure in " + what}));
    reader.finish();
    return scene;
  });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene.h"

#include <cstring>

#include "core/base/error.h"

namespace cei3d {
namespace {

static_assert(sizeof(Vec3f) == 3 * sizeof(float));
static_assert(sizeof(SgLobe) == 7 * sizeof(float));

// [n][3] floats.
Tensor pack(const std::vector<Vec3f>& v) {
  Tensor t{{int64_t(v.size()), 3}, std::vector<float>(3 * v.size()), {}};
  if (!v.empty()) std::memcpy(t.f32.data(), v.data(), t.f32.size() * sizeof(float));
  return t;
}

const Tensor& array(const Tensors& in, const std::string& name, int64_t rows, int64_t columns) {
  const Tensor& t = require_tensor(in, name, {rows, columns});
  if (int64_t(t.f32.size()) != rows * columns) fail("array '{}' does not hold 32-bit floats", name);
  return t;
}

const Tensor& bytes(const Tensors& in, const std::string& name, int64_t rows, int64_t columns) {
  const Tensor& t = require_tensor(in, name, {rows, columns});
  if (int64_t(t.u8.size()) != rows * columns) fail("array '{}' does not hold bytes", name);
  return t;
}

std::vector<Vec3f> unpack(const Tensors& in, const std::string& name, int64_t rows) {
  const Tensor& t = array(in, name, rows, 3);
  std::vector<Vec3f> v(static_cast<size_t>(rows));
  if (!v.empty()) std::memcpy(v.data(), t.f32.data(), t.f32.size() * sizeof(float));
  return v;
}

Json vector_json(Vec3d v) { return Json::array({v.x, v.y, v.z}); }

Vec3d vector_from(const Json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

int64_t rows_of(const Json& j) {
  const int64_t n = j.get<int64_t>();
  if (n < 0 || n > (int64_t(1) << 32)) fail("a size in the scene's description is {}", n);
  return n;
}

void save_field(const std::shared_ptr<const Field>& field, const std::string& name, Tensors& tensors,
                Json& head) {
  if (!field) return;
  head[name] = to_json(field->config());
  field->params().save(tensors, name);
}

std::shared_ptr<const Field> load_field(const std::string& name, const Tensors& tensors, const Json& head) {
  if (!head.contains(name)) return nullptr;
  auto field = std::make_shared<Field>(field_config_from_json(head.at(name)), 0);
  field->params().load(tensors, name);
  return field;
}

// Triangles travel as the bytes of three little-endian u32 each: the tensor format of the store knows F32 and
// U8.
void save_surface(const Surface& surface, Tensors& tensors, Json& head) {
  const Mesh& mesh = surface.mesh();
  head["surface"] = {{"vertices", mesh.positions.size()},
                     {"triangles", mesh.triangles.size()},
                     {"normals", !mesh.normals.empty()},
                     {"sky_directions", kSkyDirections}};
  tensors["surface/positions"] = pack(mesh.positions);
  if (!mesh.normals.empty()) tensors["surface/normals"] = pack(mesh.normals);
  Tensor triangles{
      {int64_t(mesh.triangles.size()), 12}, {}, std::vector<uint8_t>(mesh.triangles.size() * 12)};
  if (!mesh.triangles.empty()) std::memcpy(triangles.u8.data(), mesh.triangles.data(), triangles.u8.size());
  tensors["surface/triangles"] = std::move(triangles);
  tensors["surface/visibility"] = {
      {int64_t(mesh.positions.size()), kSkyDirections / 8}, {}, surface.visibility()};
}

void check_triangles(const Mesh& mesh) {
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t)
      if (v >= mesh.positions.size())
        fail("a triangle of the stored surface names vertex {} of {}", v, mesh.positions.size());
}

std::shared_ptr<const Surface> load_surface(const Tensors& tensors, const Json& j) {
  if (j.at("sky_directions") != kSkyDirections)
    fail("the stored surface has {} sky directions, this program uses {}; reconstruct the object again",
         j.at("sky_directions").dump(), kSkyDirections);
  const int64_t vertices = rows_of(j.at("vertices")), faces = rows_of(j.at("triangles"));
  Mesh mesh;
  mesh.positions = unpack(tensors, "surface/positions", vertices);
  if (j.at("normals").get<bool>()) mesh.normals = unpack(tensors, "surface/normals", vertices);
  mesh.triangles.resize(size_t(faces));
  const Tensor& triangles = bytes(tensors, "surface/triangles", faces, 12);
  if (faces > 0) std::memcpy(mesh.triangles.data(), triangles.u8.data(), triangles.u8.size());
  check_triangles(mesh);
  std::vector<uint8_t> visibility = bytes(tensors, "surface/visibility", vertices, kSkyDirections / 8).u8;
  return std::make_shared<Surface>(std::move(mesh), std::move(visibility));
}

void save_light(const SgMixture& light, Tensors& tensors, Json& head) {
  head["light"] = {{"lobes", light.lobes.size()}};
  Tensor t{{int64_t(light.lobes.size()), 7}, std::vector<float>(7 * light.lobes.size()), {}};
  if (!light.lobes.empty()) std::memcpy(t.f32.data(), light.lobes.data(), t.f32.size() * sizeof(float));
  tensors["light"] = std::move(t);
}

SgMixture load_light(const Tensors& tensors, const Json& j) {
  SgMixture light;
  light.lobes.resize(size_t(rows_of(j.at("lobes"))));
  const Tensor& t = array(tensors, "light", int64_t(light.lobes.size()), 7);
  if (!light.lobes.empty()) std::memcpy(light.lobes.data(), t.f32.data(), t.f32.size() * sizeof(float));
  return light;
}

void save_handlers(const HandlerPoints& points, Tensors& tensors, Json& head) {
  head["handlers"] = {{"points", points.positions.size()}, {"spacing", points.spacing}};
  tensors["handlers/positions"] = pack(points.positions);
  tensors["handlers/normals"] = pack(points.normals);
  tensors["handlers/footprints"] = {{int64_t(points.footprints.size()), 1}, points.footprints, {}};
}

std::shared_ptr<const HandlerPoints> load_handlers(const Tensors& tensors, const Json& j) {
  const int64_t n = rows_of(j.at("points"));
  auto points = std::make_shared<HandlerPoints>();
  points->positions = unpack(tensors, "handlers/positions", n);
  points->normals = unpack(tensors, "handlers/normals", n);
  points->footprints = array(tensors, "handlers/footprints", n, 1).f32;
  points->spacing = j.at("spacing").get<float>();
  return points;
}

// A key that is missing or of another type, said as the damage it is.
template <class F>
auto checked(const char* what, F load) {
  try {
    return load();
  } catch (const Json::exception& e) {
    fail("the description of the {} is damaged ({}); restore the project from a copy, or make it again", what,
         e.what());
  }
}

}  // namespace

void save_scene(const Scene& scene, Tensors& tensors, Json& head) {
  head["center"] = vector_json(scene.normalization.center);
  head["scale"] = scene.normalization.scale;
  head["up"] = vector_json(scene.up);
  head["material"] = {{"roughness", scene.material.roughness},
                      {"specular", scene.material.specular},
                      {"metalness", scene.material.metalness}};
  save_field(scene.sdf, "sdf", tensors, head);
  save_field(scene.albedo, "albedo", tensors, head);
  if (scene.surface) save_surface(*scene.surface, tensors, head);
  save_light(scene.light, tensors, head);
  if (scene.handlers) save_handlers(*scene.handlers, tensors, head);
}

Scene load_scene(const Tensors& tensors, const Json& head) {
  return checked("object", [&] {
    Scene scene;
    scene.normalization.center = vector_from(head.at("center"));
    scene.normalization.scale = head.at("scale").get<double>();
    scene.up = vector_from(head.at("up"));
    const Json& material = head.at("material");
    scene.material = {material.at("roughness").get<float>(), material.at("specular").get<float>(),
                      material.at("metalness").get<float>()};
    scene.sdf = load_field("sdf", tensors, head);
    scene.albedo = load_field("albedo", tensors, head);
    if (head.contains("surface")) scene.surface = load_surface(tensors, head.at("surface"));
    scene.light = load_light(tensors, head.at("light"));
    if (head.contains("handlers")) scene.handlers = load_handlers(tensors, head.at("handlers"));
    return scene;
  });
}

void save_layer(const EditLayer& layer, Tensors& tensors, Json& head) {
  head["id"] = layer.id;
  layer.region.save(tensors, head["region"]);
  save_field(layer.albedo, "albedo", tensors, head);
}

EditLayer load_layer(const Tensors& tensors, const Json& head) {
  return checked("edit", [&] {
    EditLayer layer;
    layer.id = head.at("id").get<std::string>();
    layer.region = Region::load(tensors, head.at("region"));
    layer.albedo = load_field("albedo", tensors, head);
    return layer;
  });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/export/gltf.h"

#include <gmock/gmock.h>

#include <cstring>

#include "core/base/error.h"
#include "core/base/json.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

struct Glb {
  Json json;
  std::string binary;
};

Glb parse_glb(const std::string& bytes) {
  const auto number = [&](size_t i) {
    uint32_t v;
    std::memcpy(&v, &bytes[i], 4);
    return v;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number(4), 2u);
  EXPECT_EQ(number(8), bytes.size());
  const uint32_t length = number(12);
  EXPECT_EQ(length % 4, 0u);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
  EXPECT_EQ(number(20 + length), bytes.size() - 28 - length);
  return {Json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
}

TEST(Gltf, HoldsTheMeshAndTheMaterial) {
  const Mesh m = tetrahedron();
  const Glb glb = parse_glb(encode_glb(m, {{{0.25f, 0.7f, 1}}, {}}, upright({0, 0, 1})));
  const Json& j = glb.json;
  const Json& primitive = j["meshes"][0]["primitives"][0];
  const auto array_of = [&](int accessor) {
    const Json& a = j["accessors"][accessor];
    const Json& v = j["bufferViews"][a["bufferView"].get<int>()];
    return glb.binary.substr(v["byteOffset"], v["byteLength"]);
  };
  EXPECT_EQ(array_of(primitive["attributes"]["POSITION"]),
            std::string(reinterpret_cast<const char*>(m.positions.data()), 48));
  EXPECT_EQ(array_of(primitive["attributes"]["NORMAL"]),
            std::string(reinterpret_cast<const char*>(m.normals.data()), 48));
  EXPECT_EQ(array_of(primitive["indices"]),
            std::string(reinterpret_cast<const char*>(m.triangles.data()), 48));
  EXPECT_EQ(j["accessors"][0]["max"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(j["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"], 0.25f);
  EXPECT_EQ(j["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 1.0f);
  const Json& specular = j["materials"][0]["extensions"]["KHR_materials_specular"];
  EXPECT_EQ(specular["specularColorFactor"][0], 1.4f);
  EXPECT_EQ(specular["specularFactor"], 1);
  EXPECT_EQ(j["extensionsUsed"][0], "KHR_materials_specular");
  EXPECT_FALSE(parse_glb(encode_glb(m, {{{}}, {}}, upright({0, 0, 1}))).json.contains("extensionsUsed"));
}

// Weaker at all angles, as glTF's factor is.
TEST(Gltf, WritesAWeakReflectionAsAFactorOnTheWhole) {
  const Json j = parse_glb(encode_glb(tetrahedron(), {{{0.25f, 0.1f, 0}}, {}}, upright({0, 0, 1}))).json;
  const Json& specular = j["materials"][0]["extensions"]["KHR_materials_specular"];
  EXPECT_EQ(specular["specularColorFactor"][0], 1);
  EXPECT_EQ(specular["specularFactor"], 0.2f);
}

TEST(Gltf, EveryMaterialHasItsTriangles) {
  const Mesh m = tetrahedron();
  const Glb glb =
      parse_glb(encode_glb(m, {{{0.2f, 0.5f, 0}, {0.8f, 0.5f, 1}}, {1, 0, 1, 1}}, upright({0, 0, 1})));
  const Json &j = glb.json, &primitives = j["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2u);
  for (const auto& [primitive, material, count] : {std::tuple(0, 0, 3), {1, 1, 9}}) {
    EXPECT_EQ(primitives[primitive]["material"], material);
    EXPECT_EQ(j["accessors"][primitives[primitive]["indices"].get<int>()]["count"], count);
  }
  const Json& first =
      j["bufferViews"][j["accessors"][primitives[0]["indices"].get<int>()]["bufferView"].get<int>()];
  EXPECT_EQ(glb.binary.substr(first["byteOffset"], 12),
            std::string(reinterpret_cast<const char*>(&m.triangles[1]), 12));
  EXPECT_EQ(j["materials"][1]["pbrMetallicRoughness"]["roughnessFactor"], 0.8f);
}

TEST(Gltf, NodeTurnsUpToY) {
  for (const Vec3d up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{-1, 0, 0}, Vec3d{1, 2, -2}}) {
    const Json q = parse_glb(encode_glb(tetrahedron(), {{{}}, {}}, upright(up))).json["nodes"][0]["rotation"];
    const Vec3d v{q[0], q[1], q[2]}, u = normalize(up);
    const double w = q[3];
    EXPECT_NEAR(dot(v, v) + w * w, 1, 1e-12);
    const Vec3d turned = u + cross(v, cross(v, u) + u * w) * 2.0;  // q u q*
    EXPECT_NEAR(length(turned - Vec3d{0, 1, 0}), 0, 1e-9);
  }
}

TEST(Gltf, EmptyOrBrokenMeshesAreErrors) {
  EXPECT_THROW(encode_glb(Mesh(), {{{}}, {}}, upright({0, 0, 1})), Error);
  Mesh m = tetrahedron();
  m.positions[1].y = NAN;
  EXPECT_THROW(encode_glb(m, {{{}}, {}}, upright({0, 0, 1})), Error);
}

}  // namespace
}  // namespace cei3d

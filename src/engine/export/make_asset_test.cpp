// SPDX-License-Identifier: Apache-2.0
#include "engine/export/make_asset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "core/math/shading.h"
#include "engine/export/gltf_asset.h"
#include "engine/export/obj.h"
#include "engine/export/tangents.h"
#include "engine/export/test_ball.h"
#include "engine/io/png_file.h"
#include "engine/io/webp_file.h"
#include "model/geometry/unwrap/raster.h"

namespace cei3d {
namespace {

constexpr int kTexels = 128;

// An untrained distance field is a ball up to what its last layer adds; without that layer it is one exactly.
std::shared_ptr<const Field> ball_field() {
  FieldConfig c;
  c.outputs = 1;
  c.width = 16;
  c.sphere_radius = kBallRadius;
  auto field = std::make_shared<Field>(c, 1);
  for (auto& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  return field;
}

// A ball whose upper half is rough metal.
Scene ball() {
  Scene s = test_ball(5, {.frequencies = 1});
  s.sdf = ball_field();
  EditLayer layer;
  layer.id = "0001-material";
  layer.part = "the top";
  Region::Points points;
  for (const Vec3f p : s.surface->mesh().positions)
    if (p.z > 0.1f) {
      points.positions.push_back(p);
      points.normals.push_back(normalize(p));
      points.reach.push_back(0.03f);
    }
  layer.region = Region(points);
  layer.material.roughness = 0.8f;
  layer.material.metalness = 1.0f;
  return with_layer(s, layer);
}

class MakeAsset : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Progress quiet;
    AssetOptions options;
    options.faces = 600;  // the flat faces lie up to 1.6 % of the radius below the ball
    options.texture = kTexels;
    made_ = new MadeAsset(make_asset(make_device(), ball(), "ball", options, quiet));
  }
  static void TearDownTestSuite() { delete made_; }

  // Calls use(texel index, direction from the ball's middle) for the texels of the charts.
  template <class Use>
  static void for_each_point(const Use& use) {
    const TexturedMesh& m = made_->asset.mesh;
    for (const auto& t : m.triangles) {
      const auto corner = [&](int k) { return m.uv[t[k]] * float(kTexels); };
      for_each_texel(corner(0), corner(1), corner(2), kTexels, kTexels,
                     [&](int x, int y, float b1, float b2) {
                       use(size_t(y) * kTexels + x,
                           normalize(at_corners(m.positions, t, b1, b2) - Vec3f{1, 2, 3}), t, b1, b2);
                     });
    }
  }
  static MadeAsset* made_;
};
MadeAsset* MakeAsset::made_ = nullptr;

TEST_F(MakeAsset, IsTheSurfaceInTheFrameOfTheCapture) {
  EXPECT_LE(made_->report.triangles, 600u);
  EXPECT_GT(made_->report.atlas.used, 0.4);
  EXPECT_EQ(made_->report.atlas.flipped, 0u);
  EXPECT_EQ(made_->report.atlas.overlapping, 0u);
  EXPECT_GT(made_->report.error, 0);
  EXPECT_LT(made_->report.error, 0.02);
  for (const Vec3f p : made_->asset.mesh.positions)
    EXPECT_NEAR(length(p - Vec3f{1, 2, 3}), kBallRadius / 2, 1e-4);
}

// Viewers see the normals of the fine surface, not of the flat faces.
TEST_F(MakeAsset, NormalsThatAViewerComputesAreThoseOfTheBall) {
  const TexturedMesh& m = made_->asset.mesh;
  size_t seen = 0;
  for_each_point([&](size_t texel, Vec3f direction, const auto& t, float b1, float b2) {
    const float* value = &made_->textures.normal.data[3 * texel];
    const TangentFrame frame{at_corners(m.tangents, t, b1, b2), at_corners(m.normals, t, b1, b2)};
    const Vec3f coordinates{2 * value[0] - 1, 2 * value[1] - 1, 2 * value[2] - 1};
    EXPECT_GT(dot(frame.direction(coordinates), direction), 0.999f);
    ++seen;
  });
  EXPECT_GT(seen, size_t(kTexels * kTexels) / 3);
}

TEST_F(MakeAsset, ColorsAreThoseOfTheFieldAtTheSurfacePoint) {
  const Scene scene = ball();
  std::vector<Vec3f> points;
  std::vector<size_t> texels;
  for_each_point([&](size_t texel, Vec3f direction, const auto&, float, float) {
    points.push_back(direction * kBallRadius);
    texels.push_back(texel);
  });
  const std::vector<Vec3f> wanted = scene.albedo->eval3(make_device(), points);
  for (size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(made_->textures.base_color.data[3 * texels[i] + size_t(c)], wanted[i][c], 0.01);
}

TEST_F(MakeAsset, MaterialsVaryFromTexelToTexel) {
  size_t rough = 0, smooth = 0;
  for_each_point([&](size_t texel, Vec3f direction, const auto&, float, float) {
    const float* orm = &made_->textures.orm.data[3 * texel];
    EXPECT_NEAR(orm[0], 1, 1e-5);  // the whole sky is visible
    if (direction.z > 0.35f) {
      EXPECT_EQ(orm[1], 0.8f);
      EXPECT_EQ(orm[2], 1);
      ++rough;
    } else if (direction.z < 0) {
      EXPECT_EQ(orm[1], 0.4f);
      EXPECT_EQ(orm[2], 0);
      ++smooth;
    }
  });
  EXPECT_GT(rough, 1000u);
  EXPECT_GT(smooth, 1000u);
  EXPECT_TRUE(made_->textures.specular.empty());
}

// With the factors that the file gives them, glTF's F0 and F90 are those of the shading model.
TEST_F(MakeAsset, APictureOfStrengthsHoldsBothOfGltfsFactors) {
  Textures textures = made_->textures;
  textures.specular = Image(4, 1, 1);
  textures.specular.data = {0, 0.2f, 0.5f, 1};
  Asset asset = made_->asset;
  asset.pictures = encode(textures, PictureKind::png);
  const Json material = Json::parse(gltf_files(asset, "ball.gltf").back().bytes)["materials"][0];
  const Json& specular = material["extensions"]["KHR_materials_specular"];
  EXPECT_EQ(specular["specularTexture"]["index"], specular["specularColorTexture"]["index"]);
  const Image picture = decode_png(asset.pictures.specular->bytes, "specular.png");
  ASSERT_EQ(picture.channels, 4);
  for (int x = 0; x < 4; ++x) {
    const float strength = textures.specular.data[size_t(x)], *texel = picture.at(x, 0);
    const float factor = texel[3] * specular["specularFactor"].get<float>(),
                color = linear_from_srgb(texel[0]) * specular["specularColorFactor"][0].get<float>();
    EXPECT_NEAR(factor, f90_of(strength, 0.0f), 0.005);
    EXPECT_NEAR(0.04f * color * factor, dielectric_f0(strength, 0.0f), 0.0005);
  }
}

TEST_F(MakeAsset, GltfNamesItsFilesAndTheBufferHoldsTheArrays) {
  const std::vector<FileBytes> files = gltf_files(made_->asset, "folder/my ball.gltf");
  const Json j = Json::parse(files.back().bytes);
  EXPECT_EQ(files.back().path, "folder/my ball.gltf");
  std::set<std::string> named{j["buffers"][0]["uri"]};
  for (const Json& image : j["images"]) named.insert(image["uri"].get<std::string>());
  EXPECT_EQ(named.size(), files.size() - 1);
  for (size_t i = 0; i + 1 < files.size(); ++i) EXPECT_TRUE(named.count(files[i].path.filename().string()));
  EXPECT_EQ(files[files.size() - 2].bytes.size(), j["buffers"][0]["byteLength"].get<size_t>());
  const Json& attributes = j["meshes"][0]["primitives"][0]["attributes"];
  for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"})
    EXPECT_EQ(j["accessors"][attributes[name].get<int>()]["count"], made_->asset.mesh.positions.size());
  EXPECT_EQ(decode_png(files[0].bytes, "base color").width, kTexels);
}

TEST_F(MakeAsset, PartsAreNodesThatShareVertices) {
  const Json j = Json::parse(gltf_files(made_->asset, "ball.gltf").back().bytes);
  EXPECT_EQ(j["nodes"][0]["children"], (Json{1, 2}));
  EXPECT_FALSE(j["nodes"][0].contains("mesh"));
  size_t indices = 0;
  for (size_t part = 0; part < 2; ++part) {
    const Json& node = j["nodes"][part + 1];
    EXPECT_EQ(node["name"], part == 0 ? "ball" : "the top");
    const Json& primitive = j["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
    indices += j["accessors"][primitive["indices"].get<size_t>()]["count"].get<size_t>();
    EXPECT_EQ(primitive["attributes"], j["meshes"][0]["primitives"][0]["attributes"]);
  }
  EXPECT_EQ(indices, 3 * made_->asset.mesh.triangles.size());
  const std::vector<Vec3f>& at = made_->asset.mesh.positions;
  for (const auto& t : made_->asset.parts[1].triangles)
    EXPECT_GT((at[t[0]].z + at[t[1]].z + at[t[2]].z) / 3, 3);  // the middle of the ball
}

TEST_F(MakeAsset, WebpPicturesNeedTheirExtension) {
  Asset asset = made_->asset;
  asset.pictures = encode(made_->textures, PictureKind::webp);
  const std::vector<FileBytes> files = gltf_files(asset, "ball.gltf");
  const Json j = Json::parse(files.back().bytes);
  EXPECT_EQ(j["extensionsRequired"], Json::array({"EXT_texture_webp"}));
  for (const Json& texture : j["textures"])
    EXPECT_TRUE(texture["extensions"]["EXT_texture_webp"].contains("source") && !texture.contains("source"));
  EXPECT_EQ(decode_webp(files[0].bytes, "base color").width, kTexels);
}

TEST_F(MakeAsset, ObjHasEveryVertexAndFace) {
  const std::vector<FileBytes> files = obj_files(made_->asset, made_->textures, "ball.obj", true);
  const std::string& text = files.back().bytes;
  size_t vertices = 0, faces = 0;
  for (size_t at = 0; at != std::string::npos; at = text.find('\n', at + 1)) {
    vertices += text.compare(at, 3, "\nv ") == 0;
    faces += text.compare(at, 3, "\nf ") == 0;
  }
  EXPECT_EQ(vertices, made_->asset.mesh.positions.size());
  EXPECT_EQ(faces, made_->asset.mesh.triangles.size());
  EXPECT_NE(text.find("\ng ball\nf "), std::string::npos);
  EXPECT_NE(text.find("\ng the_top\nf "), std::string::npos);
  EXPECT_NE(text.find("mtllib ball.mtl"), std::string::npos);
}

TEST(MakeAssetErrors, AnObjectWithoutSurfaceIsOne) {
  Progress quiet;
  EXPECT_THROW(make_asset(make_device(), Scene(), "nothing", {}, quiet), Error);
}

}  // namespace
}  // namespace cei3d

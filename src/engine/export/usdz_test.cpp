// SPDX-License-Identifier: Apache-2.0
#include "engine/export/usdz.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "engine/io/zip_file.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

using testing::HasSubstr;

uint32_t number(const std::string& bytes, size_t at, int width) {
  uint32_t v = 0;
  std::memcpy(&v, &bytes[at], size_t(width));
  return v;
}

TEST(StoredZip, EveryFileStartsAtAMultipleOf64AndLibzipReadsIt) {
  std::vector<FileBytes> files;
  for (const size_t size : {0, 1, 63, 64, 1000, 5})
    files.push_back({"name_" + std::string(size % 7 * 9, 'x') + std::to_string(size),
                     std::string(size, char('a' + size % 26))});
  const std::string zip = stored_zip(files);
  const auto read = unzip(zip, "test.zip", 1 << 20);
  ASSERT_EQ(read.size(), files.size());
  size_t at = 0;
  for (const FileBytes& f : files) {
    EXPECT_EQ(read.at(f.path.string()), f.bytes);
    ASSERT_EQ(number(zip, at, 4), 0x04034b50u);
    EXPECT_EQ(number(zip, at + 8, 2), 0u);  // stored
    const size_t data = at + 30 + number(zip, at + 26, 2) + number(zip, at + 28, 2);
    EXPECT_EQ(data % 64, 0u) << f.path;
    EXPECT_EQ(zip.substr(data, f.bytes.size()), f.bytes);
    at = data + f.bytes.size();
  }
}

TEST(Usdz, HoldsALayerAndThePicturesItNames) {
  const Mesh m = tetrahedron();
  Asset asset;
  asset.name = "thing";
  asset.mesh = {m.positions, m.normals, m.normals, {{0, 0}, {1, 0}, {0, 0.25f}, {1, 1}}, m.triangles};
  asset.pictures.base_color = {"base_color.png", "one", PictureKind::png};
  asset.pictures.orm = {"orm.jpg", "two", PictureKind::jpeg};
  asset.pictures.normal = {"normal.png", "three", PictureKind::png};
  asset.placement = upright({0, 0, 1});
  asset.placement.scale = 2;
  const auto files = unzip(encode_usdz(asset), "thing.usdz", 1 << 20);
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files.at("orm.jpg"), "two");
  const std::string& layer = files.at("model.usda");
  EXPECT_EQ(layer.rfind("#usda 1.0", 0), 0u);
  for (const auto& [name, bytes] : files)
    EXPECT_TRUE(name == "model.usda" || layer.find("@" + name + "@") != std::string::npos) << name;
  EXPECT_THAT(layer, HasSubstr("[(0, 1), (1, 1), (0, 0.75), (1, 0)]"));  // v grows upwards
  EXPECT_THAT(layer, HasSubstr("faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]"));
  EXPECT_EQ(std::count(layer.begin(), layer.end(), '{'), std::count(layer.begin(), layer.end(), '}'));
}

}  // namespace
}  // namespace cei3d

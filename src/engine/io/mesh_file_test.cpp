// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <random>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/io/npy.h"
#include "engine/io/ply.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {
using testing::HasSubstr;

template <class Decode>
void abuse(const std::string& bytes, Decode decode) {
  for (size_t n = 0; n < bytes.size(); ++n) EXPECT_THROW(decode(bytes.substr(0, n), "cut"), Error) << n;
  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    std::string s = bytes;
    for (int k = 0; k < 3; ++k) s[random() % s.size()] = char(random());
    try {
      decode(s, "flipped");
    } catch (const Error&) {
    }
  }
}

TEST(Ply, RoundTrip) {
  const TempFolder temp;
  const Mesh m = tetrahedron();
  write_ply(temp.path() / "m.ply", m);
  const Mesh back = read_ply(temp.path() / "m.ply");
  EXPECT_EQ(back.triangles, m.triangles);
  ASSERT_EQ(back.positions.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(length(back.positions[i] - m.positions[i]), 0);
    EXPECT_EQ(length(back.normals[i] - m.normals[i]), 0);
    EXPECT_NEAR(length(back.colors[i] - m.colors[i]), 0, 0.01);
  }
  Mesh bare;
  bare.positions = m.positions;
  bare.triangles = m.triangles;
  EXPECT_TRUE(decode_ply(encode_ply(bare), "x").normals.empty());
  abuse(encode_ply(m), decode_ply);
}

TEST(Ply, ForeignPropertiesAndPolygons) {
  std::string text =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty double "
      "y\r\nproperty double z\r\n"
      "property uchar quality\r\nelement face 1\r\nproperty uchar flags\r\nproperty list uchar uint "
      "vertex_index\r\nend_header\r\n";
  const double p[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const auto& v : p) text.append(reinterpret_cast<const char*>(v), 24), text += '\7';
  const uint32_t quad[4] = {0, 1, 2, 3};
  text += std::string("\1\4", 2);
  text.append(reinterpret_cast<const char*>(quad), 16);
  const Mesh m = decode_ply(text, "x");
  EXPECT_EQ(m.positions[2].y, 1);
  ASSERT_EQ(m.triangles.size(), 2u);
  EXPECT_EQ(m.triangles[1], (std::array<uint32_t, 3>{0, 2, 3}));
  std::string ascii = text;
  ascii.replace(ascii.find("binary_little_endian"), 20, "ascii");
  EXPECT_THROW(decode_ply(ascii, "x"), Error);
}

TEST(Ply, HostileCountsAllocateNothing) {
  EXPECT_THROW(
      decode_ply(
          "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\nproperty uchar x\n"
          "property uchar y\nproperty uchar z\nend_header\n",
          "x"),
      Error);
  EXPECT_THROW(
      decode_ply("ply\nformat binary_little_endian 1.0\nelement junk 99999999999999\nend_header\n", "x"),
      Error);
}

TEST(Npy, RoundTripAndHeader) {
  const std::vector<float> v{1, 2, 3, 4, 5, 6};
  const std::string bytes = encode_npy(v, 2, 3);
  EXPECT_EQ((bytes.size() - 24) % 64, 0u);  // data starts at a multiple of 64
  EXPECT_THAT(bytes, HasSubstr("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"));
  const NpyArray back = decode_npy(bytes, "x");
  EXPECT_EQ(back.shape, (std::vector<int64_t>{2, 3}));
  EXPECT_EQ(back.floats(), v);
  EXPECT_THROW(encode_npy(v, 2, 2), Error);
  abuse(bytes, decode_npy);
}

TEST(Npy, BadHeadersAreErrors) {
  const auto with = [](std::string header) {
    return std::string("\x93NUMPY\x01\x00", 8) + char(header.size()) + '\0' + header + "12345678";
  };
  EXPECT_EQ(decode_npy(with("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }"), "x").data.size(),
            1u);
  for (const char* header : {"", "{}", "{'descr': '<i4', 'fortran_order': False, 'shape': (2,), }",
                             "{'descr': '<f4', 'fortran_order': True, 'shape': (1, 1, 2), }",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), }",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': 2, }",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (-2,), }",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,), }",
                             "{'descr': '<f4', 'fortran_order': False, 'shape': (4611686018427387906, 2), }",
                             "{'descr': '<f4', 'fortran_order': False"})
    EXPECT_THROW(decode_npy(with(header), "x"), Error) << header;
}

}  // namespace
}  // namespace cei3d

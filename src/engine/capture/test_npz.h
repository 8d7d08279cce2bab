// SPDX-License-Identifier: Apache-2.0
// For tests: .npz archives, and the ball of test_capture.h as an IDR folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/capture/test_capture.h"

namespace cei3d {

// type: as NumPy writes it ("<f8"); shape: "(4, 4)".
inline std::string test_npy(const std::string& type, const std::string& shape, const std::string& data,
                            bool fortran = false) {
  const std::string header = "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
                             ", 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + char(header.size()) + '\0' + header + data;
}

inline std::string test_npy(std::span<const double> m44, bool fortran = false) {
  return test_npy("<f8", "(4, 4)", {reinterpret_cast<const char*>(m44.data()), m44.size_bytes()}, fortran);
}

inline uint32_t test_crc32(const std::string& bytes) {
  uint32_t crc = ~0u;
  for (const char c : bytes) {
    crc ^= uint8_t(c);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

// A ZIP of stored files. [APPNOTE.TXT 4.3]
inline std::string test_zip(const std::map<std::string, std::string>& files) {
  const auto number = [](uint64_t v, int bytes) {
    std::string s;
    for (int i = 0; i < bytes; ++i, v >>= 8) s += char(v);
    return s;
  };
  std::string out, directory;
  for (const auto& [name, data] : files) {
    const std::string common = number(20, 2) + number(0, 8) + number(test_crc32(data), 4) +
                               number(data.size(), 4) + number(data.size(), 4) + number(name.size(), 2);
    directory +=
        "PK\1\2" + number(20, 2) + common + number(0, 2 + 2 + 2 + 2 + 4) + number(out.size(), 4) + name;
    out += "PK\3\4" + common + number(0, 2) + name + data;
  }
  return out + directory + "PK\5\6" + number(0, 4) + number(files.size(), 2) + number(files.size(), 2) +
         number(directory.size(), 4) + number(out.size(), 4) + number(0, 2);
}

// K [R | t] times a factor, row-major 4x4; pixel centers at whole numbers, as the format has them.
inline std::vector<double> world_mat(const Camera& c, double factor = 1) {
  const Mat3d r = transpose(c.world_from_cam);
  const Vec3d t = -(r * c.center);
  const Mat3d k{{{c.fx, c.skew, c.cx - 0.5}, {0, c.fy, c.cy - 0.5}, {0, 0, 1}}};
  const Mat3d kr = k * r;
  const Vec3d kt = k * t;
  std::vector<double> m;
  for (int i = 0; i < 3; ++i)
    for (const double x : {kr.row[i].x, kr.row[i].y, kr.row[i].z, kt[i]}) m.push_back(factor * x);
  for (const double x : {0.0, 0.0, 0.0, 1.0}) m.push_back(x);
  return m;
}

// cameras_sphere.npz, image/, mask/: images 000000.png, masks 000.png, as the DTU sets have them.
inline void write_idr(const std::filesystem::path& folder, const TestBall& ball,
                      const std::vector<TestView>& views) {
  std::map<std::string, std::string> files;
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera& c = views[i].camera;
    const std::string n = std::to_string(i), name = std::string(6 - n.size(), '0') + n;
    files["world_mat_" + n + ".npy"] = test_npy(world_mat(c, 1 + double(i)));
    const Vec3d o = ball.center;
    const double s = 1.2 * ball.radius;
    files["scale_mat_" + n + ".npy"] =
        test_npy(std::vector<double>{s, 0, 0, o.x, 0, s, 0, o.y, 0, 0, s, o.z, 0, 0, 0, 1});
    const Image rgba = ball_image(ball, c);
    Image rgb(c.width, c.height, 3), mask(c.width, c.height, 1);
    for (size_t k = 0; k < mask.data.size(); ++k) {
      for (size_t j = 0; j < 3; ++j) rgb.data[3 * k + j] = rgba.data[4 * k + j];
      mask.data[k] = rgba.data[4 * k + 3];
    }
    write_png(folder / "image" / (name + ".png"), rgb);
    write_png(folder / "mask" / (name.substr(3) + ".png"), mask);
  }
  write_file_atomic(folder / "cameras_sphere.npz", test_zip(files));
}

}  // namespace cei3d

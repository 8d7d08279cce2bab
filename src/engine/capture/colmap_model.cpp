// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/colmap_camera.h"
#include "engine/capture/words.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kNoPoint = ~uint64_t(0);

// Numbers and texts of a file, one after the other. Errors: the file ends too early.
class Bytes {
 public:
  explicit Bytes(const fs::path& path) : path_(path), data_(read_file(path)) {}

  template <class T>
  T next() {
    T value;
    if (data_.size() - used_ < sizeof(T)) broken();
    std::memcpy(&value, data_.data() + used_, sizeof(T));
    used_ += sizeof(T);
    return value;
  }
  std::string text() {
    const size_t end = data_.find('\0', used_);
    if (end == std::string::npos) broken();
    std::string out = data_.substr(used_, end - used_);
    used_ = end + 1;
    return out;
  }
  // A number of items of at least `bytes` bytes each.
  uint64_t count(size_t bytes) {
    const auto n = next<uint64_t>();
    if (n > (data_.size() - used_) / bytes) broken();
    return n;
  }
  [[noreturn]] void broken() const {
    fail("{} ends too early or is no file of COLMAP. Copy or export it again.", path_.string());
  }

 private:
  fs::path path_;
  std::string data_;
  size_t used_ = 0;
};

void set_pose(ColmapImage& image, const double (&q)[4], const double (&t)[3], const std::string& where) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 1e-9) || !std::isfinite(norm + t[0] + t[1] + t[2]))
    fail("{} has a pose that is no rotation and finite position.", where);
  const double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
  image.cam_from_world = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  image.translation = {t[0], t[1], t[2]};
}

void read_cameras_bin(const fs::path& path, ColmapModel& model) {
  Bytes in(path);
  for (uint64_t n = in.count(24); n > 0; --n) {
    const auto id = in.next<uint32_t>();
    const std::string where = fmt::format("Camera {} of {}", id, path.string());
    const ColmapCameraModel& kind = colmap_camera_model(in.next<int32_t>(), where);
    const auto width = double(in.next<uint64_t>()), height = double(in.next<uint64_t>());
    std::vector<double> params(kind.params);
    for (double& p : params) p = in.next<double>();
    model.cameras[id] = colmap_camera(kind, width, height, params, where);
  }
}

void read_images_bin(const fs::path& path, ColmapModel& model) {
  Bytes in(path);
  for (uint64_t n = in.count(73); n > 0; --n) {
    ColmapImage image;
    const auto id = in.next<uint32_t>();
    double q[4], t[3];
    for (double& v : q) v = in.next<double>();
    for (double& v : t) v = in.next<double>();
    image.camera = in.next<uint32_t>();
    image.name = in.text();
    set_pose(image, q, t, fmt::format("Image {} of {}", id, path.string()));
    for (uint64_t m = in.count(24); m > 0; --m) {
      const double x = in.next<double>(), y = in.next<double>();
      const auto point = in.next<uint64_t>();
      if (point != kNoPoint) image.points.push_back({{x, y}, point});
    }
    model.images.push_back(std::move(image));
  }
}

void read_points_bin(const fs::path& path, ColmapModel& model) {
  Bytes in(path);
  for (uint64_t n = in.count(51); n > 0; --n) {
    const auto id = in.next<uint64_t>();
    const double x = in.next<double>(), y = in.next<double>(), z = in.next<double>();
    for (int i = 0; i < 3; ++i) in.next<uint8_t>();  // color
    in.next<double>();                               // error
    for (uint64_t m = in.count(8); m > 0; --m) in.next<uint64_t>();
    model.points[id] = {x, y, z};
  }
}

void read_cameras_txt(const fs::path& path, ColmapModel& model) {
  const std::string text = read_file(path);
  for (Lines lines(text); lines.next_data();) {
    const std::string where = fmt::format("Line {} of {}", lines.number(), path.string());
    Words words(lines.line(), where);
    const auto id = uint32_t(words.whole());
    const ColmapCameraModel& kind = colmap_camera_model(std::string(words.word()), where);
    const double width = words.number(), height = words.number();
    std::vector<double> params(kind.params);
    for (double& p : params) p = words.number();
    model.cameras[id] = colmap_camera(kind, width, height, params, where);
  }
}

void read_images_txt(const fs::path& path, ColmapModel& model) {
  const std::string text = read_file(path);
  for (Lines lines(text); lines.next_data();) {
    const std::string where = fmt::format("Line {} of {}", lines.number(), path.string());
    Words words(lines.line(), where);
    ColmapImage image;
    double q[4], t[3];
    words.number();  // id
    for (double& v : q) v = words.number();
    for (double& v : t) v = words.number();
    image.camera = uint32_t(words.whole());
    image.name = std::string(words.rest());
    if (image.name.empty()) fail("{} has no image name.", where);
    set_pose(image, q, t, where);
    if (lines.next()) {  // also an empty line is that of the points
      Words points(lines.line(), fmt::format("Line {} of {}", lines.number(), path.string()));
      while (!points.at_end()) {
        const double x = points.number(), y = points.number(), point = points.number();
        if (point >= 0 && point < 9e15) image.points.push_back({{x, y}, uint64_t(point)});
      }
    }
    model.images.push_back(std::move(image));
  }
}

void read_points_txt(const fs::path& path, ColmapModel& model) {
  const std::string text = read_file(path);
  for (Lines lines(text); lines.next_data();) {
    Words words(lines.line(), fmt::format("Line {} of {}", lines.number(), path.string()));
    const uint64_t id = words.whole();
    const double x = words.number(), y = words.number(), z = words.number();
    model.points[id] = {x, y, z};
  }
}

// The binary file is the one that COLMAP reads when both are there.
void read_either(const fs::path& folder, const std::string& name, ColmapModel& model,
                 void (*bin)(const fs::path&, ColmapModel&), void (*txt)(const fs::path&, ColmapModel&)) {
  if (fs::exists(folder / (name + ".bin")))
    bin(folder / (name + ".bin"), model);
  else if (fs::exists(folder / (name + ".txt")))
    txt(folder / (name + ".txt"), model);
}

}  // namespace

bool is_colmap_model(const fs::path& folder) {
  const auto has = [&](const char* suffix) {
    return fs::is_regular_file(folder / (std::string("cameras") + suffix)) &&
           fs::is_regular_file(folder / (std::string("images") + suffix));
  };
  return has(".bin") || has(".txt");
}

size_t colmap_image_count(const fs::path& folder) {
  if (const fs::path bin = folder / "images.bin"; fs::exists(bin)) return size_t(Bytes(bin).next<uint64_t>());
  size_t n = 0;
  const std::string text = read_file(folder / "images.txt");
  for (Lines lines(text); lines.next_data(); lines.next()) ++n;
  return n;
}

ColmapModel read_colmap_model(const fs::path& folder) {
  ColmapModel model;
  read_either(folder, "cameras", model, read_cameras_bin, read_cameras_txt);
  read_either(folder, "images", model, read_images_bin, read_images_txt);
  read_either(folder, "points3D", model, read_points_bin, read_points_txt);
  std::sort(model.images.begin(), model.images.end(),
            [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });
  return model;
}

}  // namespace cei3d

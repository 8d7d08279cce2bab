// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/capture_format.h"
#include "engine/io/npy.h"
#include "engine/io/zip_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr uint64_t kMaxBytes = uint64_t(64) << 20;  // maximum size of all matrices: those of 100,000 views
using Files = std::vector<fs::path>;
using Entries = std::map<std::string, std::string>;

fs::path camera_file(const fs::path& path) {
  if (fs::is_regular_file(path)) return path;
  for (const char* name : {"cameras_sphere.npz", "cameras.npz"})
    if (fs::exists(path / name)) return path / name;
  return {};
}

std::optional<int64_t> whole_number(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  return std::stoll(text);
}

// The indices i of "<stem>i.npy", ascending.
std::vector<int64_t> indices_of(const Entries& entries, const std::string& stem) {
  std::vector<int64_t> indices;
  for (const auto& [name, bytes] : entries)
    if (name.starts_with(stem) && name.ends_with(".npy") && name.size() > stem.size() + 4)
      if (const auto i = whole_number(name.substr(stem.size(), name.size() - stem.size() - 4)))
        indices.push_back(*i);
  std::sort(indices.begin(), indices.end());
  return indices;
}

Matrix34 read_matrix(const std::string& npy, const std::string& where) {
  const NpyArray array = decode_npy(npy, where);
  if (array.shape != std::vector<int64_t>{4, 4} && array.shape != std::vector<int64_t>{3, 4})
    fail("{} should be a 4 x 4 matrix.", where);
  Matrix34 m;
  for (size_t i = 0; i < 12; ++i) m.m[i / 4][i % 4] = array.data[i];
  return m;
}

// The ball that scale_mat maps the unit ball to; the same for all views.
std::optional<ObjectBall> stated_region(const Entries& entries, int64_t camera, const std::string& where,
                                        Capture& capture) {
  const auto entry = entries.find(fmt::format("scale_mat_{}.npy", camera));
  if (entry == entries.end()) return std::nullopt;
  const Matrix34 m = read_matrix(entry->second, where);
  const Vec3d center{m.m[0][3], m.m[1][3], m.m[2][3]};
  const double radius = length(Vec3d{m.m[0][0], m.m[1][0], m.m[2][0]});
  if (std::isfinite(dot(center, center)) && std::isfinite(radius) && radius > 0)
    return ObjectBall{center, radius};
  capture.warnings.push_back(fmt::format("{} is no scale and shift; it is not used.", where));
  return std::nullopt;
}

// The file of each camera: by the number in its name if every camera finds a file or every file a camera;
// else by sorted order, as the format's own loaders do.
Files match(std::span<const int64_t> cameras, const Files& files, const fs::path& folder, Capture& capture) {
  std::map<int64_t, fs::path> by_number;
  for (const fs::path& file : files)
    if (const auto n = whole_number(file.stem().string())) by_number[*n] = file;
  Files out;
  size_t found = 0;
  for (const int64_t i : cameras) {
    const auto it = by_number.find(i);
    found += it != by_number.end();
    out.push_back(it != by_number.end() ? it->second : folder / fmt::format("{:06}.png", i));
  }
  if (found == files.size()) return out;  // some may be missing: check() lists them
  if (found == cameras.size()) {
    capture.warnings.push_back(fmt::format("{} of {} images in {} have no camera and are left out.",
                                           files.size() - found, files.size(), folder.string()));
    return out;
  }
  if (files.size() == cameras.size()) return files;
  fail(
      "The {} images in {} fit the {} cameras neither by name nor by number. Name them 000000, 000001, ... "
      "like the matrices.",
      files.size(), folder.string(), cameras.size());
}

Files match_folder(const fs::path& root, std::initializer_list<const char*> names,
                   std::span<const int64_t> cameras, Capture& capture) {
  for (const char* name : names)
    if (const Files files = images_in(root / name); !files.empty())
      return match(cameras, files, root / name, capture);
  return {};
}

// A principal point outside the image means that the camera belongs to an image of another size.
void warn_of_other_sizes(Capture& capture) {
  for (const View& v : capture.views) {
    const Camera& c = v.camera;
    if (c.cx > 0 && c.cx < c.width && c.cy > 0 && c.cy < c.height) continue;
    capture.warnings.push_back(
        fmt::format("The principal point ({:.0f}, {:.0f}) of view {} lies outside its image of {} x {}. Were "
                    "the images resized or cropped without the cameras? K has to be changed with them.",
                    c.cx, c.cy, v.name, c.width, c.height));
    return;
  }
}

}  // namespace

// RQ decomposition by Gram-Schmidt on the rows of K R, last row first; K is upper triangular with a positive
// diagonal.
Camera camera_from_projection(const Matrix34& p, const std::string& where) {
  Mat3d m;
  Vec3d last;
  for (int r = 0; r < 3; ++r) m.row[r] = {p.m[r][0], p.m[r][1], p.m[r][2]}, last[r] = p.m[r][3];
  const double det = determinant(m), size = length(m.row[0]) * length(m.row[1]) * length(m.row[2]);
  if (!std::isfinite(det) || !std::isfinite(dot(last, last)))
    fail("{} holds NaN or infinite numbers. Estimate the cameras again.", where);
  if (!(std::abs(det) > 1e-6 * size))
    fail("{} is not a projection K [R | t]: its left 3 x 3 part cannot be inverted.", where);
  Camera c;
  c.center = -(inverse(m) * last);
  if (det < 0)  // a projection is known up to a factor
    for (Vec3d& row : m.row) row = -row;
  Vec3d* rotation = m.row;
  const double k22 = length(rotation[2]);
  rotation[2] = rotation[2] / k22;
  c.cy = dot(m.row[1], rotation[2]);
  rotation[1] = rotation[1] - rotation[2] * c.cy;
  c.fy = length(rotation[1]);
  rotation[1] = rotation[1] / c.fy;
  c.cx = dot(m.row[0], rotation[2]);
  c.skew = dot(m.row[0], rotation[1]);
  rotation[0] = rotation[0] - rotation[2] * c.cx - rotation[1] * c.skew;
  c.fx = length(rotation[0]);
  rotation[0] = rotation[0] / c.fx;
  for (double* k : {&c.fx, &c.fy, &c.cx, &c.cy, &c.skew}) *k /= k22;
  c.world_from_cam = transpose(m);
  return c;
}

bool detect_idr(const fs::path& path) {
  const fs::path file = camera_file(path);
  return !file.empty() && file.extension() == ".npz";
}

Capture load_idr(const fs::path& path) {
  const fs::path file = camera_file(path), root = file.parent_path();
  Capture capture;
  capture.root = root;
  capture.format = "idr";
  const Entries entries = unzip(read_file(file), file.string(), kMaxBytes);
  const std::vector<int64_t> cameras = indices_of(entries, "world_mat_");
  if (cameras.empty()) fail("{} has no matrices world_mat_0, world_mat_1, ...", file.string());
  const Files images = match_folder(root, {"image", "images"}, cameras, capture);
  if (images.empty()) fail("There are no images in {}.", (root / "image").string());
  const Files masks = match_folder(root, {"mask", "masks"}, cameras, capture);

  ImageSize size;
  for (size_t i = 0; i < images.size() && size.width == 0; ++i) size = size_of_image(images[i]);
  if (size.width == 0) fail("No image in {} can be read.", (root / "image").string());
  for (size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = fmt::format("world_mat_{}", cameras[i]);
    View view;
    view.name = fmt::format("{}/{}", images[i].parent_path().filename().string(), images[i].stem().string());
    view.image_path = images[i];
    if (!masks.empty()) view.mask_path = masks[i];
    const std::string where = fmt::format("{} of {}", name, file.string());
    view.camera = camera_from_projection(read_matrix(entries.at(name + ".npy"), where), where);
    view.camera.cx += 0.5;  // the format's pixel centers are at whole numbers
    view.camera.cy += 0.5;
    const ImageSize own = size_of_image(images[i]);
    view.camera.width = own.width > 0 ? own.width : size.width;
    view.camera.height = own.width > 0 ? own.height : size.height;
    capture.views.push_back(std::move(view));
  }
  const std::string scale = fmt::format("scale_mat_{} of {}", cameras[0], file.string());
  capture.region = stated_region(entries, cameras[0], scale, capture);
  warn_of_other_sizes(capture);
  return capture;
}

}  // namespace cei3d

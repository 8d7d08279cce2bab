// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/write_capture.h"

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

bool is_expressible(const LensDistortion& lens) { return lens.divisor == std::array<double, 3>{}; }

// Camera-to-world, OpenGL axes.
Json pose_json(const Camera& c) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) {
    const Vec3d m = c.world_from_cam.row[r];
    rows.push_back({m.x, -m.y, -m.z, c.center[r]});
  }
  rows.push_back({0, 0, 0, 1});
  return rows;
}

Json frame_json(const Camera& c, const std::string& image) {
  return {{"file_path", image}, {"transform_matrix", pose_json(c)},
          {"w", c.width},       {"h", c.height},
          {"fl_x", c.fx},       {"fl_y", c.fy},
          {"cx", c.cx},         {"cy", c.cy}};
}

void put_lens(const LensDistortion& lens, Json& frame) {
  frame["camera_model"] = lens.kind == LensKind::fisheye ? "OPENCV_FISHEYE" : "OPENCV";
  for (size_t i = 0; i < 4; ++i) frame[fmt::format("k{}", i + 1)] = lens.radial[i];
  frame["p1"] = lens.p1, frame["p2"] = lens.p2;
}

void copy_bytes(const fs::path& from, const fs::path& to) {
  fs::create_directories(to.parent_path());
  write_file_atomic(to, read_file(from));
}

// The mask, bright where the object is.
void write_mask(const View& view, const fs::path& to) {
  if (!view.dark_object) return copy_bytes(view.mask_path, to);
  Image mask = read_image(view.mask_path);
  for (size_t i = 0; i < mask.data.size(); ++i)
    if (mask.channels != 4 || i % 4 != 3) mask.data[i] = 1 - mask.data[i];
  write_png(to, mask);
}

Json write_undistorted(const View& view, const fs::path& folder) {
  const std::string image = "images/" + view.name + ".png";
  Image rgba = load_linear_rgba(view);
  for (size_t i = 3; i < rgba.data.size(); i += 4) rgba.data[i] = std::max(rgba.data[i], 0.0f);
  write_png(folder / image, srgb_from_linear(std::move(rgba)), 16);
  return frame_json(view.camera, image);
}

Json write_view(const View& view, const fs::path& folder) {
  if (view.photo && !is_expressible(view.photo->lens())) return write_undistorted(view, folder);
  const std::string image = "images/" + view.name + view.image_path.extension().string();
  if (!view.image_path.empty()) copy_bytes(view.image_path, folder / image);
  Json frame = frame_json(view.file_camera(), image);
  if (view.photo) put_lens(view.photo->lens(), frame);
  if (view.mask_path.empty() && view.dark_object) {
    const Mask mask = load_file_mask(view);
    Image gray(mask.width, mask.height, 1);
    for (size_t i = 0; i < gray.data.size(); ++i) gray.data[i] = mask.object[i] == kObject;
    frame["mask_path"] = "masks/" + view.name + ".png";
    write_png(folder / ("masks/" + view.name + ".png"), gray);
  } else if (!view.mask_path.empty()) {
    const std::string suffix = view.dark_object ? ".png" : view.mask_path.extension().string();
    frame["mask_path"] = "masks/" + view.name + suffix;
    write_mask(view, folder / ("masks/" + view.name + suffix));
  }
  return frame;
}

}  // namespace

void write_capture(const Capture& capture, const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    fail_usage("{} exists and is not empty; name a new folder.", folder.string());
  std::vector<Json> frames(capture.views.size());
  parallel_for(int(frames.size()),
               [&](int i) { frames[size_t(i)] = write_view(capture.views[size_t(i)], folder); });
  Json j{{"frames", frames}};
  for (const Split split : {Split::train, Split::val, Split::test}) {
    Json names = Json::array();
    for (size_t i = 0; i < frames.size(); ++i)
      if (capture.views[i].split == split) names.push_back(frames[i]["file_path"]);
    if (!names.empty()) j[fmt::format("{}_filenames", split_name(split))] = std::move(names);
  }
  write_file_atomic(folder / "transforms.json", j.dump(1) + "\n");
}

}  // namespace cei3d

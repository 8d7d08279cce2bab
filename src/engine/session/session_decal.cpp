// SPDX-License-Identifier: Apache-2.0
// Pictures that are laid onto the surface: strokes of `edit paint` with a camera of their own, which looks
// along the normal and sees nothing but the picture.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/image/resample.h"
#include "engine/capture/capture.h"
#include "engine/capture/undistort.h"
#include "engine/io/image_file.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/project/project.h"
#include "engine/render/render.h"
#include "engine/session/edit_params.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

constexpr int kMaxSide = 768;  // pixels of a decal; more are finer than the painted colors

// What the decal lies on: the point, and the mean normal around it, unit frame.
struct Ground {
  Vec3d point, normal;
};

Ground ground_at(const Device& device, const Scene& scene, const Camera& camera, Vec2d pixel, double radius) {
  constexpr int kSteps = 4;  // rays to each side of the pixel
  std::vector<uint32_t> ray_of_hit;
  const Ray middle[] = {camera.ray(pixel.x, pixel.y)};
  const std::vector<Hit> first = trace_rays(device, scene, middle, ray_of_hit);
  if (first.empty()) return {{0, 0, 0}, {0, 0, 0}};
  const Vec3d point = to_double(first[0].position);
  const double step = radius * camera.fx / camera.project(point).z / kSteps;
  std::vector<Ray> rays;
  for (int y = -kSteps; y <= kSteps; ++y)
    for (int x = -kSteps; x <= kSteps; ++x)
      rays.push_back(camera.ray(pixel.x + x * step, pixel.y + y * step));
  Vec3d sum = to_double(first[0].normal);
  for (const Hit& hit : trace_rays(device, scene, rays, ray_of_hit))
    if (length(to_double(hit.position) - point) < radius) sum += to_double(hit.normal);
  return {point, length(sum) > 0 ? normalize(sum) : to_double(first[0].normal)};
}

// Axes of a camera that looks against the normal, upright as `seen` is, turned clockwise.
Mat3d decal_rotation(const Camera& seen, Vec3d normal, double turn_degrees) {
  const Mat3d axes = transpose(seen.world_from_cam);  // right, down, ahead
  const Vec3d z = -normal, down = axes.row[1] - z * dot(axes.row[1], z);
  // Where the surface faces up or down in the view, its right is clearer than its down.
  const Vec3d x = normalize(length(down) > 0.1 ? cross(down, z) : axes.row[0] - z * dot(axes.row[0], z));
  const Vec3d y = cross(z, x);
  const double t = turn_degrees * std::numbers::pi / 180;
  const Vec3d across = x * std::cos(t) + y * std::sin(t);
  return transpose(Mat3d{{across, cross(z, across), z}});
}

Camera camera_over(const Ground& ground, const Mat3d& rotation, double wide, int width, int height) {
  const double distance = 2 * wide * std::max(1.0, double(height) / width);
  Camera c;
  c.width = width;
  c.height = height;
  c.fx = c.fy = width * distance / wide;
  c.cx = width / 2.0;
  c.cy = height / 2.0;
  c.world_from_cam = rotation;
  c.center = ground.point + ground.normal * distance;
  return c;
}

// sRGB with alpha, not larger than needed.
Image decal_picture(const InputFile& file) {
  const std::string bytes = file.read(), name = file.path.string();
  const ImageFormat format = image_format(bytes, name);
  if (format != ImageFormat::png && format != ImageFormat::jpeg)
    fail("{} is no PNG or JPEG; save the decal as one.", name);
  const Image read = format == ImageFormat::png ? decode_png(bytes, name) : decode_jpeg(bytes, name);
  Image rgba(read.width, read.height, 4, 1.0f);
  const size_t channels = size_t(read.channels);
  for (size_t p = 0; p < rgba.data.size() / 4; ++p)
    for (size_t c = 0; c < 4; ++c) {
      if (c == 3 && channels < 4) continue;  // opaque
      rgba.data[4 * p + c] = read.data[p * channels + (channels < 3 ? 0 : c)];
    }
  const int n = (std::max(rgba.width, rgba.height) + kMaxSide - 1) / kMaxSide;
  return n > 1 ? srgb_from_linear(downscale(linear_from_srgb(std::move(rgba)), n)) : rgba;
}

}  // namespace

std::optional<Camera> Session::decal_camera(const Camera& seen, const DecalPlace& place, int width,
                                            int height) const {
  return threads_->run([&]() -> std::optional<Camera> {
    check_camera(seen, "The camera");
    if (!(place.width > 0 && std::isfinite(place.width)))
      fail_usage("A decal is {} wide; give a width above 0.", place.width);
    if (!std::isfinite(place.turn_degrees)) fail_usage("The angle to turn the decal by is not a number.");
    const Scene scene = project().scene();
    const Normalization& n = scene.normalization;
    const Camera unit = n.unit_from_capture(seen);
    const double wide = place.width * n.scale;
    const Ground ground = ground_at(*device_, scene, unit, place.pixel, wide / 2);
    if (length(ground.normal) == 0) return std::nullopt;
    Camera camera =
        camera_over(ground, decal_rotation(unit, ground.normal, place.turn_degrees), wide, width, height);
    camera.center = n.capture_from_unit(camera.center);
    return camera;
  });
}

PaintStroke Session::laid_decal(const PaintStroke& stroke) const {
  const Image picture = decal_picture(stroke.scribble);
  Json where = Json::object();
  put_place(project().capture(), stroke.view, stroke.camera, where);
  JsonReader reader(where, "The decal");
  const EditPlace view = place_from(project().capture(), reader);
  DecalPlace place = *stroke.decal;
  place.pixel = position_on_view(view, place.pixel);
  PaintStroke laid;
  laid.camera = decal_camera(view.camera, place, picture.width, picture.height);
  if (!laid.camera)
    fail("View {} shows the background at pixel {:.6g},{:.6g}; lay the decal on the object.", view.name,
         stroke.decal->pixel.x, stroke.decal->pixel.y);
  laid.scribble.bytes = encode_png(picture, 8);
  return laid;
}

}  // namespace cei3d

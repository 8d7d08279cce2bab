// SPDX-License-Identifier: Apache-2.0
// What a user looks at: frames in tiles, points under the pointer, photographs.
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "engine/capture/capture.h"
#include "engine/io/image_file.h"
#include "engine/metrics/psnr.h"
#include "engine/project/project.h"
#include "engine/project/stack.h"
#include "engine/render/render_cache.h"
#include "engine/session/cameras.h"
#include "engine/session/edit_plan.h"
#include "engine/session/light_choice.h"
#include "engine/session/part_mask.h"
#include "engine/session/session.h"
#include "engine/session/tiled_frame.h"
#include "model/geometry/shape/vec_json.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

std::string color_text(Vec3f linear) {
  std::string text = "#";
  for (int c = 0; c < 3; ++c)
    text += fmt::format("{:02x}", std::lround(255 * clamp(srgb_from_linear(linear[c]), 0.0f, 1.0f)));
  return text;
}

std::vector<std::string> parts_at(const Scene& scene, const Hit& hit) {
  std::vector<std::string> parts;
  for (const std::string& name : part_names(scene))
    if (inside_layer(scene, part_layer(scene, name), std::span(&hit, 1))[0]) parts.push_back(name);
  return parts;
}

}  // namespace

Json PickedPoint::json() const {
  return {{"position", vector_json(position)},
          {"normal", vector_json(normal)},
          {"depth", depth},
          {"albedo", albedo},
          {"roughness", roughness},
          {"specular", specular},
          {"metalness", metalness},
          {"parts", parts}};
}

std::unique_ptr<TiledFrame> Session::frame_of(const FrameRequest& request, Scene scene) {
  check_camera(request.camera, "The camera of the frame");
  scene.light = chosen_light(*device_, request.light, scene.light, scene.up, {project().folder() / "cache"});
  if (!request.light.is_own()) scene.residual = nullptr;
  if (request.as_photographed && request.light.env.empty()) scene = in_view(scene, request.camera);
  const Camera camera = scene.normalization.unit_from_capture(request.camera);
  project().share_layer_memory(frames_->layer_bytes());
  return std::make_unique<TiledFrame>(*threads_, *frames_, std::move(scene), camera, request.samples,
                                      request.channel);
}

std::unique_ptr<TiledFrame> Session::frame(const FrameRequest& request, const EditPreview* on_top) {
  return threads_->run([&]() -> std::unique_ptr<TiledFrame> {
    return frame_of(request, on_top ? on_top->scene() : project().scene());
  });
}

bool Session::frame_is_quick() const {
  return threads_->run([&] { return frames_->light_is_stored(project().scene()); });
}

Image Session::step_picture(const FrameRequest& request, size_t done) {
  Stack stack = project().stack();
  stack.go_to(done);
  if (const auto stale = project().first_stale(stack))
    fail("Edit {} would have to be remade; go to that step.", *stale);
  const auto frame = threads_->run([&]() -> std::unique_ptr<TiledFrame> {
    return frame_of(request, project().scene_below(stack, ""));  // below no edit: with all that are done
  });
  Image picture(request.camera.width, request.camera.height, 4);
  while (const auto tile = frame->next())
    for (int y = 0; y < tile->box.height; ++y)
      for (int i = 0; i < 4 * tile->box.width; ++i)
        picture.at(tile->box.x0, tile->box.y0 + y)[i] =
            float(tile->rgba[size_t(4 * y * tile->box.width + i)]) / 255;
  return picture;
}

std::optional<PickedPoint> Session::pick(const Camera& camera, Vec2<double> pixel) const {
  return threads_->run([&]() -> std::optional<PickedPoint> {
    check_camera(camera, "The camera");
    const Scene scene = project().scene();
    const Normalization& n = scene.normalization;
    const Camera unit = n.unit_from_capture(camera);
    const Ray rays[] = {unit.ray(pixel.x, pixel.y)};
    std::vector<uint32_t> ray_of_hit;
    const std::vector<Hit> hits = trace_rays(*device_, scene, rays, ray_of_hit);
    if (hits.empty()) return std::nullopt;
    const Appearance look = appearance_at(*device_, scene, hits);
    PickedPoint p;
    p.position = n.capture_from_unit(to_double(hits[0].position));
    p.normal = to_double(hits[0].normal);
    p.depth = dot(p.position - camera.center, to_double(camera.forward()));
    p.albedo = color_text(look.albedo[0]);
    p.roughness = look.material[0].roughness;
    p.specular = look.material[0].specular;
    p.metalness = look.material[0].metalness;
    p.parts = parts_at(scene, hits[0]);
    return p;
  });
}

Image Session::part_picture(const Camera& camera, const std::string& part, const EditPreview* preview) {
  return threads_->run([&]() -> Image {
    check_camera(camera, "The camera");
    const Scene scene = preview ? preview->scene() : project().scene();
    const Camera unit = scene.normalization.unit_from_capture(camera);
    return part_mask(scene, part_layer(scene, part), frames_->trace(scene, unit, 1)->buffer);
  });
}

std::vector<View> Session::views() const { return project().capture().views; }

Image Session::photograph(const std::string& name, int width) const {
  return threads_->run([&]() -> Image {
    const View& view = find_view(project().capture(), name);
    if (view.image_path.empty()) fail("View {} has no photograph.", view.name);
    Image image = read_linear_image(view.image_path);
    if (const int n = image.width / std::max(width, 1); n > 1) image = downscale(image, n);
    image = srgb_from_linear(std::move(image));
    return image.channels == 4 ? over_background(image, 1) : image;
  });
}

NamedCamera Session::start_camera() const {
  NamedCamera camera = turntable(project().capture(), project().head().normalization, 1).front();
  if (!views().empty()) camera.camera = views().front().camera;
  camera.name = views().empty() ? "start" : views().front().name;
  return camera;
}

}  // namespace cei3d

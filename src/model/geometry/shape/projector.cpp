// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/projector.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace {

// The four texels around a pixel position and the weights of the right and lower ones.
struct Texels {
  int x, y;
  float tx, ty;

  Texels(const Image& image, const Camera& camera, double u, double v) {
    const double s = u * image.width / camera.width - 0.5, t = v * image.height / camera.height - 0.5;
    x = int(std::floor(s));
    y = int(std::floor(t));
    tx = float(s - x);
    ty = float(t - y);
  }
};

// Clamped at the border of the image.
float texel(const Image& image, int x, int y) {
  return *image.at(min(max(x, 0), image.width - 1), min(max(y, 0), image.height - 1));
}

bool in_image(const Camera& c, double u, double v) { return u >= 0 && v >= 0 && u < c.width && v < c.height; }

Image image_of(const Tensors& tensors, const std::string& name) {
  const Tensor& t = require_tensor(tensors, name);
  if (t.shape.size() != 2 || t.shape[0] < 1 || t.shape[1] < 1 ||
      size_t(t.shape[0] * t.shape[1]) != t.f32.size())
    fail("Array '{}' of the edit is not an image. The project is damaged: undo or repeat the edit.", name);
  Image image(int(t.shape[1]), int(t.shape[0]), 1);
  image.data = t.f32;
  return image;
}

Camera camera_from(JsonReader reader) {
  const Camera c = camera_from_json(reader);
  reader.finish();
  if (c.width < 1 || c.height < 1)
    fail("The edit's camera has no pixels. The project is damaged: undo or repeat the edit.");
  return c;
}

}  // namespace

float Projector::alpha_at(double u, double v) const {
  if (!in_image(camera, u, v)) return 0;
  const Texels k(alpha, camera, u, v);
  const float top = texel(alpha, k.x, k.y) * (1 - k.tx) + texel(alpha, k.x + 1, k.y) * k.tx;
  const float bottom = texel(alpha, k.x, k.y + 1) * (1 - k.tx) + texel(alpha, k.x + 1, k.y + 1) * k.tx;
  return top * (1 - k.ty) + bottom * k.ty;
}

// Compares with the deepest of the four neighbors: on a slope the texels differ by more than the tolerance.
bool Projector::sees(double u, double v, double z) const {
  const Texels k(depth, camera, u, v);
  const float far = max(max(texel(depth, k.x, k.y), texel(depth, k.x + 1, k.y)),
                        max(texel(depth, k.x, k.y + 1), texel(depth, k.x + 1, k.y + 1)));
  return z <= far + tolerance;
}

bool Projector::covers(Vec3f position, Vec3f normal) const {
  const Vec3f to_camera = to_float(camera.center) - position;
  if (!(dot(normal, to_camera) > min_facing * length(to_camera))) return false;
  const Vec3d p = camera.project(to_double(position));
  if (!(p.z > 0) || !in_image(camera, p.x, p.y)) return false;
  return alpha_at(p.x, p.y) >= min_alpha && sees(p.x, p.y, p.z);
}

void save_projector(const Projector& p, Tensors& tensors, Json& head, const std::string& prefix) {
  head["camera"] = camera_json(p.camera);
  head["tolerance"] = p.tolerance;
  head["min_facing"] = p.min_facing;
  if (p.soft()) head["least_alpha"] = p.min_alpha;
  tensors[prefix + "alpha"] = {{p.alpha.height, p.alpha.width}, p.alpha.data, {}};
  tensors[prefix + "depth"] = {{p.depth.height, p.depth.width}, p.depth.data, {}};
}

Projector load_projector(const Tensors& tensors, JsonReader head, const std::string& prefix) {
  Projector p;
  p.camera = camera_from(head.object("camera"));
  p.tolerance = head.require<float>("tolerance");
  p.min_facing = head.require<float>("min_facing");
  p.min_alpha = head.optional("least_alpha", 0.5f);
  head.finish();
  p.alpha = image_of(tensors, prefix + "alpha");
  p.depth = image_of(tensors, prefix + "depth");
  return p;
}

}  // namespace cei3d

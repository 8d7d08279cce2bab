// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/picture.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

// Sums over the samples of one pixel.
struct PixelSum {
  int hits = 0;
  Vec3f color{0, 0, 0}, albedo{0, 0, 0}, normal{0, 0, 0};
  float depth = 0, roughness = 0, metalness = 0;

  void add(const BodyPoint& p, Vec3f radiance, float z) {
    ++hits;
    color += radiance;
    albedo += p.albedo;
    normal += p.normal;
    depth += z;
    roughness += p.material.roughness;
    metalness += p.material.metalness;
  }
};

void put_rgba(Image& image, int x, int y, Vec3f c, float alpha) {
  float* p = image.at(x, y);
  p[0] = c.x, p[1] = c.y, p[2] = c.z, p[3] = alpha;
}

void put(TrueView& out, int x, int y, const PixelSum& sum, int samples) {
  if (sum.hits == 0) return;
  const float n = float(sum.hits), alpha = n / float(samples);
  put_rgba(out.color, x, y, sum.color / n, alpha);
  put_rgba(out.albedo, x, y, sum.albedo / n, alpha);
  const Vec3f normal = normalize(sum.normal);
  for (int c = 0; c < 3; ++c) out.normal.at(x, y)[c] = normal[c];
  *out.depth.at(x, y) = sum.depth / n;
  *out.roughness.at(x, y) = sum.roughness / n;
  *out.metalness.at(x, y) = sum.metalness / n;
}

class ViewPainter {
 public:
  ViewPainter(const SyntheticScene& scene, const Camera& camera, const Sampling& sampling)
      : scene_(scene),
        camera_(camera),
        sampling_(sampling),
        tracer_(scene),
        forward_(camera.forward()),
        // Half of a pixel's diagonal at the farthest point of the body, with a margin.
        half_pixel_(float(0.75 * (length(camera.center) + 1) / std::min(camera.fx, camera.fy))) {}

  PixelSum pixel(int x, int y) const {
    PixelSum sum;
    if (!scene_.shape.body->passes_within(camera_.ray(x + 0.5, y + 0.5), half_pixel_)) return sum;
    const uint64_t item = uint64_t(y) * uint64_t(camera_.width) + uint64_t(x);
    const uint64_t key = mix_bits(mix_bits(mix_bits(sampling_.seed) ^ sampling_.view) ^ item);
    for (int i = 0; i < sampling_.samples; ++i) add_sample(x, y, SampleSequence(key, uint32_t(i)), sum);
    return sum;
  }

 private:
  void add_sample(int x, int y, SampleSequence samples, PixelSum& sum) const {
    const Vec2<float> inside = samples.pair();
    const Ray ray = camera_.ray(x + double(inside.x), y + double(inside.y));
    const float t = scene_.shape.body->cast(ray);
    if (t < 0) return;
    const BodyPoint p = body_point(scene_, ray.origin + ray.direction * t);
    sum.add(p, tracer_.radiance(p, -ray.direction, samples), t * dot(ray.direction, forward_));
  }

  const SyntheticScene& scene_;
  const Camera& camera_;
  const Sampling& sampling_;
  PathTracer tracer_;
  Vec3f forward_;
  float half_pixel_;
};

}  // namespace

TrueView draw(const SyntheticScene& scene, const Camera& camera, const Sampling& sampling) {
  const int w = camera.width, h = camera.height;
  TrueView out{.color = Image(w, h, 4),
               .albedo = Image(w, h, 4),
               .normal = Image(w, h, 3),
               .depth = Image(w, h, 1),
               .roughness = Image(w, h, 1),
               .metalness = Image(w, h, 1)};
  const ViewPainter painter(scene, camera, sampling);
  parallel_for(h, [&](int y) {
    for (int x = 0; x < w; ++x) put(out, x, y, painter.pixel(x, y), sampling.samples);
  });
  return out;
}

Image draw_unlit(const Body& body, const Camera& camera, const std::function<Vec3f(Vec3f)>& color_at) {
  Image out(camera.width, camera.height, 4);
  parallel_for(camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const float t = body.cast(ray);
      if (t >= 0) put_rgba(out, x, y, color_at(ray.origin + ray.direction * t), 1);
    }
  });
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/trace_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace cei3d {
namespace {

constexpr float kNear = 0.01f;       // distance from a start within which the surface is looked for first
constexpr float kOvershoot = 5e-4f;  // added to every step, so that marching ends behind the surface
constexpr int kMaxSteps = 64;        // steps of sphere tracing; rays along the surface take short ones
constexpr int kSamples = 64;         // samples of the rest of a ray after these steps
constexpr int kMaxBisections = 24;
const FieldTrace kUnknown{false, 0, std::numeric_limits<float>::infinity()};

// A ray on its way. [outside, inside]: depths between which the surface is, once known.
struct Probe {
  const Ray* ray;
  float depth, far;  // next depth to evaluate; end of the search
  float outside = -1, inside = -1;
  float value_outside = 0, value_inside = 0;
  float sample = 0;  // distance of samples when steps have become too many; 0: sphere tracing
  FieldTrace* out;

  bool bracketed() const { return inside >= 0; }
};

class Tracer {
 public:
  Tracer(const Device& device, const Field& sdf) : device_(device), sdf_(sdf) {}

  // Advances all probes by visit(probe, value at probe.depth), which returns whether to go on.
  void advance(std::vector<Probe*>& probes, const std::function<bool(Probe&, float)>& visit) {
    points_.clear();
    for (const Probe* p : probes) points_.push_back(p->ray->origin + p->ray->direction * p->depth);
    const std::vector<float> values = first_output(device_, sdf_, points_);
    size_t kept = 0;
    for (size_t i = 0; i < probes.size(); ++i) {
      note(*probes[i], values[i]);
      if (visit(*probes[i], values[i])) probes[kept++] = probes[i];
    }
    probes.resize(kept);
  }

 private:
  // Remembers the point of least value for misses.
  static void note(Probe& p, float value) {
    FieldTrace& best = *p.out;
    if (p.bracketed() || value >= best.value) return;
    best.depth = p.depth;
    best.value = value;
  }

  const Device& device_;
  const Field& sdf_;
  std::vector<Vec3f> points_;
};

// Depths at which a ray enters and leaves the unit sphere, from 0 on; far < near: it misses.
struct Span {
  float near, far;
};
Span in_unit_sphere(const Ray& r) {
  const float middle = -dot(r.origin, r.direction), gap = dot(r.origin, r.origin) - square(middle);
  if (gap >= 1) return {std::max(middle, 0.0f), -1};
  const float half = std::sqrt(1 - gap);
  return {std::max(middle - half, 0.0f), middle + half};
}

// Whether the surface is crossed within kNear of the expected depth.
void look_near_starts(Tracer& tracer, std::span<const float> starts, std::vector<Probe>& probes) {
  std::vector<Probe*> expected;
  for (size_t i = 0; i < probes.size(); ++i)
    if (starts[i] > kNear) {
      probes[i].depth = starts[i] - kNear;
      expected.push_back(&probes[i]);
    }
  const std::vector<Probe*> all = expected;
  tracer.advance(expected, [](Probe& p, float value) {
    p.outside = p.depth, p.value_outside = value;
    p.depth += 2 * kNear;
    return value > 0;
  });
  tracer.advance(expected, [](Probe& p, float value) {
    if (value <= 0) p.inside = p.depth, p.value_inside = value;
    return false;
  });
  for (Probe* p : all)
    if (!p->bracketed()) p->outside = -1, *p->out = kUnknown;
}

// From the near end of the sphere to the first point inside the surface.
void march(Tracer& tracer, std::vector<Probe*> probes) {
  for (int step = 0; !probes.empty(); ++step) {
    const bool sampled = step >= kMaxSteps;
    tracer.advance(probes, [&](Probe& p, float value) {
      if (value <= 0) {
        p.inside = p.depth, p.value_inside = value;
        return false;
      }
      p.outside = p.depth, p.value_outside = value;
      if (sampled && p.sample == 0) p.sample = (p.far - p.depth) / kSamples;
      p.depth += std::max(value + kOvershoot, p.sample);
      return p.depth <= p.far;
    });
  }
}

// The zero between both ends: where a straight line has it, which is exact for a plane, and halfway in every
// other round.
float next_guess(const Probe& p, int round) {
  if (round % 2 == 1) return 0.5f * (p.outside + p.inside);
  const float share = p.value_outside / (p.value_outside - p.value_inside);
  return p.outside + (p.inside - p.outside) * std::clamp(share, 0.01f, 0.99f);
}

void find_zeros(Tracer& tracer, std::vector<Probe*> probes) {
  for (Probe* p : probes) p->depth = next_guess(*p, 0);
  for (int round = 1; !probes.empty(); ++round)
    tracer.advance(probes, [&](Probe& p, float value) {
      *p.out = {true, p.depth, value};
      if (std::abs(value) <= kTraceTolerance || round == kMaxBisections) return false;
      (value > 0 ? p.outside : p.inside) = p.depth;
      (value > 0 ? p.value_outside : p.value_inside) = value;
      p.depth = next_guess(p, round);
      return true;
    });
}

// Updates the least value of each ray by samples in the middle of equal parts of a span.
void search_lowest(const Device& device, const Field& sdf, std::span<const Ray> rays,
                   std::span<const Span> spans, int samples, std::vector<FieldTrace>& out) {
  std::vector<Vec3f> points;
  const auto depth = [&](size_t i, int k) {
    return spans[i].near + (spans[i].far - spans[i].near) * (float(k) + 0.5f) / float(samples);
  };
  for (size_t i = 0; i < rays.size(); ++i)
    for (int k = 0; k < samples; ++k) points.push_back(rays[i].origin + rays[i].direction * depth(i, k));
  const std::vector<float> values = first_output(device, sdf, points);
  for (size_t i = 0; i < rays.size(); ++i)
    for (int k = 0; k < samples; ++k) {
      const float v = values[i * size_t(samples) + size_t(k)];
      if (v < out[i].value) out[i] = {v <= 0, depth(i, k), v};
    }
}

}  // namespace

std::vector<FieldTrace> lowest_along(const Device& device, const Field& sdf, std::span<const Ray> rays) {
  constexpr int kCoarse = 40, kFine = 8;
  std::vector<FieldTrace> out(rays.size(), kUnknown);
  std::vector<Span> spans;
  for (const Ray& r : rays) {
    spans.push_back(in_unit_sphere(r));
    if (spans.back().far < spans.back().near) spans.back().far = spans.back().near;
  }
  search_lowest(device, sdf, rays, spans, kCoarse, out);
  for (size_t i = 0; i < rays.size(); ++i) {
    const float step = (spans[i].far - spans[i].near) / kCoarse;
    spans[i] = {out[i].depth - step, out[i].depth + step};
  }
  search_lowest(device, sdf, rays, spans, kFine, out);
  return out;
}

std::vector<FieldTrace> trace_field(const Device& device, const Field& sdf, std::span<const Ray> rays,
                                    std::span<const float> starts) {
  std::vector<FieldTrace> out(rays.size(), kUnknown);
  std::vector<Probe> probes;
  for (size_t i = 0; i < rays.size(); ++i)
    probes.push_back({.ray = &rays[i], .depth = 0, .far = 0, .out = &out[i]});
  Tracer tracer(device, sdf);
  if (!starts.empty()) look_near_starts(tracer, starts, probes);
  std::vector<Probe*> searched, crossing;
  for (Probe& p : probes) {
    if (p.bracketed()) continue;
    const Span span = in_unit_sphere(*p.ray);
    p.depth = span.near, p.far = span.far;
    searched.push_back(&p);
  }
  march(tracer, searched);
  for (Probe& p : probes) {
    if (!p.bracketed()) continue;
    if (p.outside < 0)
      *p.out = {true, p.inside, p.value_inside};
    else
      crossing.push_back(&p);
  }
  find_zeros(tracer, crossing);
  return out;
}

}  // namespace cei3d

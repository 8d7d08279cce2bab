// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/carve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/math/adam.h"
#include "core/math/fog.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "engine/reconstruct/geometry/occupancy.h"

namespace cei3d {

namespace {

constexpr int kRaysPerChunk = 128;
constexpr uint32_t kNone = ~0u;
constexpr float kDark = 0.01f;  // a ray ends where less light is left

using Cell = std::array<float, 4>;  // density, display-encoded color

struct CellGrad {
  uint32_t cell;
  SampleWeight<float> seen;
  Cell d;  // of the loss
};

Vec3f color_of(const Cell& c) { return {c[1], c[2], c[3]}; }

class Fog {
 public:
  Fog(const PixelStore& pixels, const VisualHull& hull, const CarveOptions& options)
      : pixels_(pixels),
        hull_(hull),
        options_(options),
        size_((hull.hi.x - hull.lo.x) / float(hull.n)),
        id_(hull.inside.size(), kNone),
        chunks_(options.rays / kRaysPerChunk) {
    for (size_t i = 0; i < hull.inside.size(); ++i)
      if (hull.inside[i]) {
        id_[i] = uint32_t(place_.size());
        place_.push_back(uint32_t(i));
      }
    cells_.assign(place_.size(), {options.density, 0.5f, 0.5f, 0.5f});
    for (auto* v : {&grad_, &mean_, &square_}) v->assign(place_.size(), {});
    lit_.assign(place_.size(), 0);
  }

  void step(int step) {
    parallel_for(int(chunks_.size()), [&](int c) {
      chunks_[c].clear();
      for (int r = 0; r < kRaysPerChunk; ++r)
        trace(Rng(options_.seed, uint64_t(step), uint64_t(c * kRaysPerChunk + r)), chunks_[c]);
    });
    const bool settled = step > options_.steps * 3 / 4;
    std::vector<uint32_t> touched;
    for (const auto& grads : chunks_)
      for (const CellGrad& s : grads) {
        Cell& sum = grad_[s.cell];
        if (sum == Cell{}) touched.push_back(s.cell);
        for (int k = 0; k < 4; ++k) sum[k] += s.d[k];
        if (settled) lit_[s.cell] = std::max(lit_[s.cell], s.seen.transmittance);
      }
    const float decay = std::pow(0.2f, float(step) / float(options_.steps));
    for (const uint32_t i : touched) update(i, decay);
  }

  // The hull's grid without cells that are empty.
  std::vector<uint8_t> solid() const {
    std::vector<uint8_t> inside = hull_.inside;
    for (size_t i = 0; i < cells_.size(); ++i)
      if (lit_[i] > options_.lit && opacity(cells_[i]) < options_.empty_opacity) inside[place_[i]] = 0;
    return inside;
  }

 private:
  float opacity(const Cell& c) const { return fog_opacity(c[0], size_); }

  uint32_t id_at(Vec3f p) const {
    const Vec3f q = (p - hull_.lo) / size_;
    const int n = hull_.n, x = int(q.x), y = int(q.y), z = int(q.z);
    if (min(q.x, min(q.y, q.z)) < 0 || std::max({x, y, z}) >= n) return kNone;
    return id_[(size_t(z) * n + y) * n + x];
  }

  // The gradient of one pixel's loss.
  void trace(Rng rng, std::vector<CellGrad>& out) const {
    const Pixel& p = pixels_.pixels()[rng.below(uint32_t(pixels_.pixels().size()))];
    const float u = rng.uniform(), v = rng.uniform();
    const Ray ray = pixels_.cameras()[p.view].ray(p.x + u, p.y + v);
    const auto [near, far] = sphere_span(ray, 1);
    if (!(near < far)) return;
    const size_t first = out.size();
    Composite<float> seen = fog_ray<float>();
    for (float t = near + size_ * rng.uniform(); t < far && seen.coverage < 1 - kDark; t += size_) {
      const uint32_t i = id_at(ray.origin + ray.direction * t);
      if (i == kNone) continue;
      out.push_back({i, seen.add(opacity(cells_[i]), color_of(cells_[i])), {}});
    }
    const Target target = pixels_.target(p);
    FogGrad<float> grad(seen, {target.srgb, target.alpha, options_.opacity_weight}, size_);
    for (size_t k = out.size(); k-- > first;) {
      CellGrad& s = out[k];
      const Cell& c = cells_[s.cell];
      const FogCellGrad<float> g = grad.add(opacity(c), s.seen, color_of(c));
      s.d = {g.d_density, g.d_color.x, g.d_color.y, g.d_color.z};
    }
  }

  // Adam without bias correction.
  void update(uint32_t i, float decay) {
    const float rates[] = {options_.density_rate / size_, options_.color_rate, options_.color_rate,
                           options_.color_rate};
    const float high[] = {3 / size_, 1, 1, 1};
    for (int k = 0; k < 4; ++k) {
      const AdamStep step{decay * rates[k], 0.8f, 0.95f, 1e-7f, false};
      adam_update(step, grad_[i][k], cells_[i][k], mean_[i][k], square_[i][k]);
      cells_[i][k] = std::clamp(cells_[i][k], 0.0f, high[k]);
    }
    grad_[i] = {};
  }

  const PixelStore& pixels_;
  const VisualHull& hull_;
  CarveOptions options_;
  float size_;                   // side of a cell
  std::vector<uint32_t> id_;     // stored cell of each hull cell; kNone: not inside of the hull
  std::vector<uint32_t> place_;  // hull cell of each stored cell
  std::vector<Cell> cells_, grad_, mean_, square_;
  std::vector<float> lit_;  // maximum light that reached the cell in the last steps
  std::vector<std::vector<CellGrad>> chunks_;
};

// Cells next to one that has `value` (edges and corners count) take it.
std::vector<uint8_t> spread(const std::vector<uint8_t>& grid, int n, uint8_t value) {
  std::vector<uint8_t> out = grid;
  parallel_for(n, [&](int z) {
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (int k = 0; k < 27; ++k) {
          const int X = x + k % 3 - 1, Y = y + k / 3 % 3 - 1, Z = z + k / 9 - 1;
          if (std::min({X, Y, Z}) < 0 || std::max({X, Y, Z}) >= n) continue;
          if (grid[(size_t(Z) * n + Y) * n + X] == value) out[(size_t(z) * n + y) * n + x] = value;
        }
  });
  return out;
}

}  // namespace

VisualHull carve(const PixelStore& pixels, const VisualHull& hull, const CarveOptions& options,
                 const Progress& progress) {
  Fog fog(pixels, hull, options);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    fog.step(step);
  }
  VisualHull out = hull;
  out.inside = fog.solid();
  for (int k = 0; k < options.opening; ++k) out.inside = spread(out.inside, hull.n, 1);
  for (int k = 0; k < options.opening; ++k) out.inside = spread(out.inside, hull.n, 0);
  for (size_t i = 0; i < out.inside.size(); ++i) out.inside[i] &= hull.inside[i];
  return out;
}

}  // namespace cei3d

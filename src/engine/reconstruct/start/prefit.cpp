// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/prefit.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "core/math/trilinear.h"

namespace cei3d {

namespace {

// Squared distance along one line: lower envelope of the parabolas rooted at f.
void transform_line(const std::vector<float>& f, std::vector<float>& out) {
  const int n = int(f.size());
  std::vector<int> root(n);
  std::vector<float> border(n + 1);
  int k = 0;
  root[0] = 0;
  border[0] = -1e20f;
  border[1] = 1e20f;
  const auto meet = [&](int a, int b) {
    return ((f[b] + float(b) * b) - (f[a] + float(a) * a)) / (2.0f * float(b - a));
  };
  for (int q = 1; q < n; ++q) {
    float s = meet(root[k], q);
    while (s <= border[k]) s = meet(root[--k], q);
    root[++k] = q;
    border[k] = s;
    border[k + 1] = 1e20f;
  }
  k = 0;
  for (int q = 0; q < n; ++q) {
    while (border[k + 1] < float(q)) ++k;
    out[q] = float(q - root[k]) * float(q - root[k]) + f[root[k]];
  }
}

// Distance in cells from every cell to the nearest one where `target` is set.
std::vector<float> distance_to(const std::vector<uint8_t>& target, int n) {
  std::vector<float> d(target.size());
  for (size_t i = 0; i < d.size(); ++i) d[i] = target[i] ? 0.0f : 1e6f;
  const size_t strides[] = {1, size_t(n), size_t(n) * n};
  for (int axis = 0; axis < 3; ++axis) {
    const size_t step = strides[axis], a = strides[(axis + 1) % 3], b = strides[(axis + 2) % 3];
    parallel_for(n, [&](int i) {
      std::vector<float> line(n), out(n);
      for (int j = 0; j < n; ++j) {
        float* base = &d[size_t(i) * a + size_t(j) * b];
        for (int k = 0; k < n; ++k) line[k] = base[size_t(k) * step];
        transform_line(line, out);
        for (int k = 0; k < n; ++k) base[size_t(k) * step] = out[k];
      }
    });
  }
  for (float& v : d) v = std::sqrt(v);
  return d;
}

}  // namespace

std::vector<float> signed_distance(const VisualHull& hull) {
  std::vector<uint8_t> outside(hull.inside.size());
  for (size_t i = 0; i < outside.size(); ++i) outside[i] = !hull.inside[i];
  std::vector<float> to_inside = distance_to(hull.inside, hull.n), to_outside = distance_to(outside, hull.n);
  const float cell = (hull.hi.x - hull.lo.x) / float(hull.n);
  for (size_t i = 0; i < to_inside.size(); ++i)
    to_inside[i] = cell * (hull.inside[i] ? 0.5f - to_outside[i] : to_inside[i] - 0.5f);
  return to_inside;
}

float DistanceGrid::at(Vec3f p) const {
  return trilinear(p, n, [&](int x, int y, int z) { return values[(size_t(z) * n + y) * n + x]; });
}

void prefit(const Device& device, Field& sdf, const DistanceGrid& grid, const PrefitOptions& options,
            const Progress& progress) {
  const std::vector<float>& distance = grid.values;
  std::vector<uint32_t> near;  // cells close to the surface
  for (size_t i = 0; i < distance.size(); ++i)
    if (std::abs(distance[i]) < 0.08f) near.push_back(uint32_t(i));
  if (near.empty())
    fail("The visual hull of the masks is empty: masks and camera poses disagree, or the masks are wrong.");

  FieldTrainer::Options rates;
  rates.network_rate = options.layer_rate;
  FieldTrainer trainer(sdf, rates);
  const int n = grid.n, batch = 2048, outputs = sdf.config().outputs;
  std::vector<Vec3f> x(batch);
  std::vector<float> target(batch);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    for (int i = 0; i < batch; ++i) {
      Rng rng(options.seed, uint64_t(step), uint64_t(i));
      const uint32_t cell =
          i % 4 ? near[rng.below(uint32_t(near.size()))] : rng.below(uint32_t(distance.size()));
      const auto at = [n](uint32_t k) { return (float(k) + 0.5f) * 2 / float(n) - 1; };
      x[i] = {at(cell % n), at(cell / n % n), at(cell / n / n)};
      target[i] = distance[cell];
    }
    trainer.step(
        device, x,
        [&](int begin, int end, const float* out, float* d_out) {
          for (int i = begin; i < end; ++i)
            d_out[size_t(i - begin) * outputs] =
                huber(out[size_t(i - begin) * outputs] - target[i], 0.02f).gradient / float(batch);
        },
        options.steps > 1 ? std::pow(0.1f, float(step) / float(options.steps - 1)) : 1.0f, options.levels);
  }
}

}  // namespace cei3d

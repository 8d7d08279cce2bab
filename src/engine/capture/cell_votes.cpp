// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/cell_votes.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace cei3d {

MaskSample sample_mask(const HullMask& view, Vec3d p) {
  const Vec3d at = view.camera.project(p);
  if (!(at.z > 0 && at.x >= 0 && at.y >= 0 && at.x < view.camera.width && at.y < view.camera.height))
    return MaskSample::nothing;
  const uint8_t pixel = view.mask[size_t(at.y) * size_t(view.camera.width) + size_t(at.x)];
  return pixel == kUnknown  ? MaskSample::nothing
         : pixel == kObject ? MaskSample::object
                            : MaskSample::background;
}

Vec3d Cells::center(size_t cell) const {
  const size_t m = size_t(n);
  const Vec3d corner{double(cell % m), double(cell / m % m), double(cell / (m * m))};
  return (corner + Vec3d{0.5, 0.5, 0.5}) * (2.0 / n) - Vec3d{1, 1, 1};
}

int Cells::at(Vec3d p) const {
  const auto along = [&](double v) { return int(std::floor((v + 1) / 2 * n)); };
  const int x = along(p.x), y = along(p.y), z = along(p.z);
  const bool inside = x >= 0 && y >= 0 && z >= 0 && x < n && y < n && z < n;
  return inside ? (z * n + y) * n + x : -1;
}

std::vector<MaskSample> samples_of(const HullMask& view, const Cells& cells) {
  std::vector<MaskSample> out(cells.count());
  const size_t slice = size_t(cells.n) * size_t(cells.n);
  parallel_for(cells.n, [&](int z) {
    for (size_t i = size_t(z) * slice; i < size_t(z + 1) * slice; ++i)
      out[i] = sample_mask(view, cells.center(i));
  });
  return out;
}

CellVotes::CellVotes(const Cells& cells, double tolerance)
    : cells_(cells), tolerance_(tolerance), seen_(cells.count()), against_(cells.count()) {}

void CellVotes::add(std::span<const MaskSample> samples) {
  ++views_;
  for (size_t i = 0; i < samples.size(); ++i) {
    seen_[i] = uint16_t(seen_[i] + (samples[i] != MaskSample::nothing));
    against_[i] = uint16_t(against_[i] + (samples[i] == MaskSample::background));
  }
}

bool CellVotes::supported(Vec3d p, MaskSample own) const {
  const int cell = cells_.at(p);
  if (cell < 0) return false;
  const int seen = seen_[size_t(cell)] - (own != MaskSample::nothing),
            against = against_[size_t(cell)] - (own == MaskSample::background);
  return seen >= std::max(2, views_ / 3) && against <= tolerance_ * seen;
}

Area CellVotes::supported_cells(MaskSample own) const {
  Area out(cells_.count());
  for (size_t i = 0; i < out.size(); ++i) out[i] = supported(cells_.center(i), own);
  return out;
}

bool ray_meets_cells(const Camera& camera, int x, int y, const Cells& cells, const Area& area) {
  return ray_meets(camera, x, y, cells, [&](Vec3d p) {
    const int cell = cells.at(p);
    return cell >= 0 && area[size_t(cell)];
  });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/resample.h"
#include "core/math/quantile.h"
#include "engine/capture/doctor.h"
#include "engine/capture/filled_gaps.h"
#include "engine/capture/loose_border.h"

namespace cei3d {
namespace {

constexpr int kBorderMask = 640;  // pixels of the longer side, at most
// Of the object's pixels. A mask stands out: share > kShare + kOutlier x median of all masks.
constexpr double kShare = 0.002, kOutlier = 2;

std::vector<std::string> names_of(std::span<const JudgedMask> masks, const std::vector<Area>& areas) {
  std::vector<std::string> names;
  for (size_t i = 0; i < masks.size(); ++i)
    if (!areas[i].empty()) names.push_back(masks[i].view->name);
  return names;
}

}  // namespace

std::vector<Area> check_gaps(std::span<const JudgedMask> masks, const Normalization& normalization,
                             std::vector<Finding>& findings) {
  std::vector<HullMask> hull;
  for (const JudgedMask& m : masks) hull.push_back({m.view->camera, m.mask});
  const SmallMasks small = small_masks(hull, normalization, kGapMask);
  std::vector<Area> areas = filled_gaps(small);
  parallel_for(int(areas.size()), [&](int k) {
    const auto i = size_t(k);
    const Camera &reduced = small.cameras[i], &full = hull[i].camera;
    if (!areas[i].empty())
      areas[i] = enlarged(areas[i], reduced.width, reduced.height, full.width, full.height);
  });
  const std::vector<std::string> names = names_of(masks, areas);
  if (!names.empty())
    findings.push_back(
        {Severity::warning,
         fmt::format("{} of {} masks fill gaps that the other views look through, or hold what they do not "
                     "show: {}.",
                     names.size(), masks.size(), some_names(names)),
         "Correct these masks. Where they contradict the other views, `reconstruct` does not use them."});
  return areas;
}

MaskBorder look_at_border(const View& view, const Image& rgba, std::span<const uint8_t> mask) {
  MaskBorder out;
  // Without a mask file the mask is the image's transparency, and there is no background to look at.
  if (view.mask_path.empty()) return out;
  const HullMask full{view.camera, mask};
  const SmallMasks small = small_masks({&full, 1}, Normalization(), kBorderMask);
  out.width = small.cameras[0].width, out.height = small.cameras[0].height;
  const Image photograph = downscale(rgba, reduction_of(rgba.width, rgba.height, kBorderMask));
  Area loose = loose_border(photograph, small.views()[0]);
  const auto object = std::count(small.masks[0].begin(), small.masks[0].end(), kObject);
  out.share = double(pixels_in(loose)) / double(std::max<std::ptrdiff_t>(object, 1));
  if (out.share > kShare) out.loose = std::move(loose);
  return out;
}

std::vector<Area> check_borders(std::span<const JudgedMask> masks, std::vector<Finding>& findings) {
  std::vector<Area> areas(masks.size());
  std::vector<double> shares;
  for (const JudgedMask& m : masks) shares.push_back(m.border ? m.border->share : 0);
  if (shares.empty()) return areas;
  const double most = kShare + kOutlier * median(shares);
  for (size_t i = 0; i < masks.size(); ++i) {
    if (shares[i] <= most) continue;
    const MaskBorder& b = *masks[i].border;
    const Camera& camera = masks[i].view->camera;
    areas[i] = enlarged(b.loose, b.width, b.height, camera.width, camera.height);
  }
  const std::vector<std::string> names = names_of(masks, areas);
  if (!names.empty())
    findings.push_back(
        {Severity::note,
         fmt::format("{} of {} masks seem to be drawn wider than the object, by the colors of the "
                     "photographs: {}.",
                     names.size(), masks.size(), some_names(names)),
         "`reconstruct` does not use the pixels along their outlines that look like the background."});
  return areas;
}

}  // namespace cei3d

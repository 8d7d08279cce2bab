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

// Names the masks whose areas are not empty; nothing where there is none. what: of such masks.
void report(std::span<const JudgedMask> masks, const std::vector<Area>& areas, Severity severity,
            const std::string& what, const std::string& fix, std::vector<Finding>& findings) {
  std::vector<std::string> names;
  for (size_t i = 0; i < masks.size(); ++i)
    if (!areas[i].empty()) names.push_back(masks[i].view->name);
  if (names.empty()) return;
  findings.push_back(
      {severity, fmt::format("{} of {} masks {}: {}.", names.size(), masks.size(), what, some_names(names)),
       fix, names});
}

}  // namespace

std::vector<Area> check_gaps(std::span<const JudgedMask> masks, const Normalization& normalization,
                             std::vector<Finding>& findings) {
  std::vector<HullMask> hull;
  for (const JudgedMask& m : masks) hull.push_back({m.view->camera, m.mask});
  const SmallMasks small = small_masks(hull, normalization, kGapMask);
  Area has_vote;
  for (const JudgedMask& m : masks) has_vote.push_back(!m.moved);
  std::vector<Area> areas = filled_gaps(small, has_vote);
  parallel_for(int(areas.size()), [&](int i) {
    areas[size_t(i)] = at_full_size(areas[size_t(i)], small.cameras[size_t(i)], hull[size_t(i)].camera);
  });
  report(masks, areas, Severity::warning,
         "fill gaps that the other views look through, or hold what they do not show",
         "Correct these masks. Where they contradict the other views, `reconstruct` does not use them.",
         findings);
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
  out.share = share_of_object(loose, small.masks[0]);
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
  report(masks, areas, Severity::note,
         "seem to be drawn wider than the object, by the colors of the photographs",
         "`reconstruct` does not use the pixels along their outlines that look like the background.",
         findings);
  return areas;
}

}  // namespace cei3d

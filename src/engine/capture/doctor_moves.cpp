// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <numeric>

#include "core/base/error.h"
#include "engine/capture/doctor.h"
#include "engine/capture/moved_areas.h"

namespace cei3d {
namespace {

constexpr int kMaxSide = 160;   // pixels: enough to find a part, and quick
constexpr int kFineSide = 640;  // of the area where it is

// By the names of the photographs, whose numbers count up: img_9 before img_10.
std::vector<size_t> order_taken(std::span<const JudgedMask> masks) {
  std::vector<size_t> order(masks.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return strverscmp(masks[a].view->name.c_str(), masks[b].view->name.c_str()) < 0;
  });
  return order;
}

Finding finding_of(const MovedPart& part, size_t views, const std::string& before, const std::string& after) {
  const size_t later = views - part.first;
  return {Severity::warning,
          fmt::format("A part of the object was moved between {} and {}: where it is, the masks of the {} "
                      "views before and the {} after contradict each other.",
                      before, after, part.first, later),
          fmt::format("`reconstruct` shows it as the views {} the move do, and does not use the others where "
                      "it is. Photograph the object without moving anything to have it from all sides.",
                      part.earlier ? "before" : "after"),
          {before, after}};
}

}  // namespace

std::vector<Area> check_moves(std::span<const JudgedMask> masks, const Normalization& normalization,
                              std::vector<Finding>& findings) {
  const std::vector<size_t> order = order_taken(masks);
  std::vector<HullMask> hull;
  for (const size_t i : order) hull.push_back({masks[i].view->camera, masks[i].mask});
  std::vector<Area> unsure(masks.size());
  const std::optional<MovedPart> part = find_moved_part(small_masks(hull, normalization, kMaxSide));
  if (!part) return unsure;
  const SmallMasks fine = small_masks(hull, normalization, kFineSide);
  const std::vector<Area> areas = moved_areas(fine, *part);
  for (size_t k = 0; k < order.size(); ++k)
    unsure[order[k]] = at_full_size(areas[k], fine.cameras[k], hull[k].camera);
  findings.push_back(finding_of(*part, masks.size(), masks[order[part->first - 1]].view->name,
                                masks[order[part->first]].view->name));
  return unsure;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/normalize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/axis_box.h"
#include "core/math/quantile.h"
#include "engine/capture/capture.h"
#include "engine/capture/capture_images.h"

namespace cei3d {
namespace {

Vec3d solve(const Mat3d& a, Vec3d b) {  // symmetric, by Cramer's rule
  const Vec3d c0 = cross(a.row[1], a.row[2]), c1 = cross(a.row[2], a.row[0]), c2 = cross(a.row[0], a.row[1]);
  const double det = dot(a.row[0], c0), trace = a.row[0].x + a.row[1].y + a.row[2].z;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (!(det > 1e-6 * trace * trace * trace / 27)) return {nan, nan, nan};
  return (c0 * b.x + c1 * b.y + c2 * b.z) / det;
}

// A silhouette: the leftmost and rightmost pixel of each row, which include the extremes of its outline.
struct Silhouette {
  const HullMask* view;
  std::vector<Vec2<double>> outline;  // pixel centers
  Vec3d axis;                         // unit, from the camera through the middle of the silhouette's box
};

Vec3d direction(const Camera& c, double u, double v) {
  const double y = (v - c.cy) / c.fy, x = (u - c.cx - c.skew * y) / c.fx;
  return normalize(c.world_from_cam * Vec3d{x, y, 1.0});
}

bool find_silhouette(const HullMask& view, Silhouette& out) {
  const int w = view.camera.width, h = view.camera.height;
  double x0 = w, x1 = 0, y0 = h, y1 = 0;
  for (int y = 0; y < h; ++y) {
    const auto row = view.mask.subspan(size_t(y) * w, size_t(w));
    const auto is_set = [](uint8_t m) { return m == kObject; };
    const auto first = std::find_if(row.begin(), row.end(), is_set);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), is_set).base() - 1;
    const double left = double(first - row.begin()), right = double(last - row.begin()) + 1;
    for (const double x : {left, right})
      for (const double edge : {0.0, 1.0}) out.outline.push_back({x, y + edge});
    x0 = std::min(x0, left), x1 = std::max(x1, right), y0 = std::min(y0, double(y)), y1 = y + 1.0;
  }
  if (out.outline.empty()) return false;
  out.view = &view;
  out.axis = direction(view.camera, (x0 + x1) / 2, (y0 + y1) / 2);
  return true;
}

std::vector<Silhouette> find_silhouettes(std::span<const HullMask> masks) {
  std::vector<Silhouette> all(masks.size());
  std::vector<uint8_t> found(masks.size());
  parallel_for(int(masks.size()), [&](int i) { found[i] = find_silhouette(masks[i], all[i]); });
  std::vector<Silhouette> out;
  for (size_t i = 0; i < masks.size(); ++i)
    if (found[i]) out.push_back(std::move(all[i]));
  return out;
}

// Largest distance from `center` to a line of sight through the silhouette: half the width of the object
// around that point.
double reach(const Silhouette& s, Vec3d center) {
  double best = 0;
  const Vec3d to_center = center - s.view->camera.center;
  for (const auto& p : s.outline)
    best = std::max(best, length(cross(direction(s.view->camera, p.x, p.y), to_center)));
  return best;
}

Normalization first_box(const std::vector<Silhouette>& silhouettes) {
  std::vector<Vec3d> origins, axes;
  for (const Silhouette& s : silhouettes) {
    origins.push_back(s.view->camera.center);
    axes.push_back(s.axis);
  }
  const Vec3d center = nearest_point_to_lines(origins, axes);
  if (!std::isfinite(dot(center, center)))
    fail(
        "The cameras do not determine where the object is: their lines of sight are parallel, or poses are "
        "not finite. Photograph the object from several sides, and check the poses.");
  std::vector<double> reaches;
  for (const Silhouette& s : silhouettes) reaches.push_back(reach(s, center));
  // One mask with a stray pixel must not enlarge the box: long objects are within 3 medians, stray pixels
  // mostly not.
  const double half = std::min(*std::max_element(reaches.begin(), reaches.end()), 3 * median(reaches)) * 1.05;
  if (!(half > 0)) fail("The masks do not determine the object's size.");
  return {center, 1 / half};
}

struct Vote {
  std::vector<Vec3d> cells;  // centers of inside cells, capture frame
  double half_diagonal = 0;  // of a cell
};

// Hull in the cube [-1, 1]^3 of `box`, clipped to the region.
Vote vote(std::span<const HullMask> masks, const Normalization& box, int n, int tolerated,
          const std::optional<ObjectBall>& region = {}) {
  std::vector<HullMask> local(masks.begin(), masks.end());
  for (HullMask& m : local) m.camera = box.unit_from_capture(m.camera);
  const int min_seen = std::max(2, int(masks.size()) / 3);
  const VisualHull hull = visual_hull(local, n, {-1, -1, -1}, {1, 1, 1}, tolerated, min_seen);
  Vote out;
  for (size_t i = 0; i < hull.inside.size(); ++i) {
    if (!hull.inside[i]) continue;
    const Vec3d cell{double(i % n), double(i / n % n), double(i / n / n)};
    const Vec3d middle = box.capture_from_unit((cell + Vec3d{0.5, 0.5, 0.5}) * (2.0 / n) - Vec3d{1, 1, 1});
    if (!region || length(middle - region->center) <= region->radius) out.cells.push_back(middle);
  }
  out.half_diagonal = std::sqrt(3.0) / n / box.scale;
  return out;
}

// Bounding cube of points, as the transform that maps it to [-1, 1]^3.
Normalization cube_around(const Vote& v) {
  const AxisBoxOf<double> box = box_of(v.cells);
  const Vec3d size = box.size();
  const double half = std::max({size.x, size.y, size.z}) / 2 + 2 * v.half_diagonal;
  return {(box.min + box.max) / 2.0, 1 / half};
}

// Smallest enclosing ball, to 1 %: shrinking steps towards the farthest point. [Badoiu and Clarkson 2003]
Normalization sphere_around(const Vote& v, Vec3d center) {
  double radius = 0;
  for (int i = 1; i <= 100; ++i) {
    Vec3d far = center;
    radius = 0;
    for (const Vec3d p : v.cells)
      if (const double d = length(p - center); d > radius) radius = d, far = p;
    if (i < 100) center += (far - center) / double(i + 1);
  }
  return {center, kObjectRadius / (radius + v.half_diagonal)};
}

// Strict where all silhouettes agree; otherwise one view in twenty may be wrong.
int choose_tolerance(std::span<const HullMask> masks, const Normalization& box,
                     std::vector<std::string>* warnings) {
  const int tolerated = int(masks.size()) / 20;
  const size_t strict = vote(masks, box, 48, 0).cells.size();
  const size_t lenient = tolerated > 0 ? vote(masks, box, 48, tolerated).cells.size() : strict;
  if (strict >= 0.6 * double(lenient)) return 0;
  if (warnings)
    warnings->push_back(
        "Some masks disagree with the others (up to one in twenty was outvoted): look for cut or empty "
        "masks.");
  return tolerated;
}

}  // namespace

Vec3d nearest_point_to_lines(std::span<const Vec3d> origins, std::span<const Vec3d> directions) {
  Mat3d a{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  Vec3d b{0, 0, 0};
  for (size_t i = 0; i < origins.size(); ++i) {
    const Vec3d d = directions[i];
    b += origins[i] - d * dot(d, origins[i]);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) a.row[r][c] += (r == c) - d[r] * d[c];
  }
  return solve(a, b);
}

Normalization normalization_from_masks(std::span<const HullMask> masks, std::vector<std::string>* warnings,
                                       const std::optional<ObjectBall>& region) {
  const std::vector<Silhouette> silhouettes = find_silhouettes(masks);
  if (silhouettes.empty())
    fail("No mask has a pixel set: the object is nowhere. Check the alpha channel or the mask files.");
  if (silhouettes.size() < 2)
    fail("Only one view shows the object; its place and size need at least two, better fifty.");
  if (region) {
    const Normalization cube{region->center, 1 / region->radius};
    const int tolerated = choose_tolerance(masks, cube, warnings);
    if (const Vote held = vote(masks, cube, 96, tolerated, region); !held.cells.empty())
      return sphere_around(held, region->center);
    if (warnings)
      warnings->push_back(
          "The region that the capture states (scale_mat) does not hold the object; it is not used.");
  }
  Normalization box = first_box(silhouettes);
  const int tolerated = choose_tolerance(masks, box, warnings);
  const Vote coarse = vote(masks, box, 64, tolerated);
  if (coarse.cells.empty())
    fail(
        "The masks have no volume in common: masks and camera poses disagree. Check that the images and "
        "poses belong together, and the axes convention of the poses.");
  box = cube_around(coarse);
  const Vote fine = vote(masks, box, 96, tolerated);
  return sphere_around(fine.cells.empty() ? coarse : fine, box.center);
}

Normalization find_normalization(const Capture& capture) {
  const std::vector<View> views = views_of(capture, Split::train);
  std::vector<Mask> masks(views.size());
  parallel_for(int(views.size()), [&](int i) { masks[i] = load_mask(views[i]); });
  std::vector<HullMask> hull;
  for (size_t i = 0; i < views.size(); ++i)
    if (masks[i].stated) hull.push_back({views[i].camera, masks[i].object});
  if (hull.empty())
    fail(
        "{} has neither masks nor an alpha channel, so the object cannot be told from the background. Give "
        "PNGs with alpha, or mask files.",
        capture.root.string());
  return normalization_from_masks(hull, nullptr, capture.region);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/object_masks.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/image/area.h"
#include "core/math/quantile.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/mask_votes.h"
#include "engine/io/image_file.h"
#include "engine/photos/first_masks.h"
#include "engine/photos/photo_pixels.h"
#include "model/scene/normalization.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Numbers of prompts of the second round. The box constrains the mask most; many prompts on the object make
// the outline ragged.
constexpr size_t kOnObject = 2, kBesideObject = 4;
constexpr double kMargin = 0.1;  // margin of the box around the object, as a share of its longer side

View with_mask(View view, const fs::path& file) {
  view.mask_path = file;
  view.dark_object = false;
  return view;
}

// The consensus of all masks, projected into every view, also into those without a mask of their own.
struct Consensus {
  std::vector<Camera> cameras;  // small, capture frame
  std::vector<Area> areas;
};

// The first mask of a view at the size that is compared; a view without one counts as background.
SmallMasks small_first_mask(const View& view, const fs::path& file) {
  if (fs::exists(file)) {
    const Mask mask = load_mask(with_mask(view, file));
    const HullMask hull{view.camera, mask.object};
    return small_masks({&hull, 1}, Normalization());
  }
  const Camera small = scaled(view.camera, reduction_of(view.camera.width, view.camera.height));
  return {{small}, {std::vector<uint8_t>(size_t(small.width) * small.height, kBackground)}};
}

// The ball about the points on the object, enlarged.
Normalization ball_of(const SparsePoints& points, const PointBelief& belief) {
  constexpr double kQuantile = 0.98;     // of the distances; those beyond it are taken for outliers
  constexpr double kRadiusFactor = 1.3;  // parts of the object without points lie outside of the points
  std::vector<double> axis[3], distances;
  for (size_t i = 0; i < belief.size(); ++i)
    for (int a = 0; a < 3 && belief[i] > 0; ++a) axis[a].push_back(points.positions[i][a]);
  if (axis[0].empty()) fail("No triangulated point lies on the object.");
  Normalization n;
  for (int a = 0; a < 3; ++a) n.center[a] = median(axis[a]);
  for (size_t i = 0; i < axis[0].size(); ++i)
    distances.push_back(length(Vec3d{axis[0][i], axis[1][i], axis[2][i]} - n.center));
  n.scale = 1 / (kRadiusFactor * quantile(std::move(distances), kQuantile));
  return n;
}

Consensus agree(const MaskRequest& r, const Normalization& normalization) {
  SmallMasks small;
  for (const View& v : r.views) {
    SmallMasks one = small_first_mask(v, r.first_masks / (v.name + ".png"));
    small.cameras.push_back(one.cameras[0]);
    small.masks.push_back(std::move(one.masks[0]));
  }
  Consensus out{small.cameras, {}};
  for (Camera& c : small.cameras) c = normalization.unit_from_capture(c);
  for (const MaskDoubt& d : vote_on_masks(small)) out.areas.push_back(d.consensus);
  return out;
}

// The consensus in the pixels of the photograph.
struct PhotoArea {
  BelievedPixels pixels;
  PixelBox object;  // around the object; width 0: it is not seen
  PixelBox box;     // around the object, with a margin
};

PhotoArea photo_area(const View& view, const Camera& small, const Area& area) {
  const Area core = eroded(area, small.width, small.height, 1),
             grown = dilated(area, small.width, small.height, 2);
  const double n = double(view.camera.width) / small.width;
  PhotoArea out;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const size_t i = size_t(y) * small.width + x;
      const Vec2d pinhole{(x + 0.5) * n, (y + 0.5) * n};
      const std::optional<Vec2d> at =
          view.photo ? photo_from_pinhole(*view.photo, view.camera, pinhole) : std::optional(pinhole);
      if (!at) continue;
      const Vec2f pixel{float(at->x), float(at->y)};
      (core[i] ? out.pixels.in : grown[i] ? out.pixels.unknown : out.pixels.out).push_back(pixel);
    }
  out.object = box_around(out.pixels.in, 0, whole(view));
  out.box = box_around(out.pixels.in, kMargin, whole(view));
  return out;
}

// Pixels of the object that are neighbors of each other, by their index.
using Piece = std::vector<uint32_t>;
std::vector<Piece> pieces_of(const Image& mask) {
  std::vector<uint8_t> open(mask.data.size());
  for (size_t i = 0; i < open.size(); ++i) open[i] = mask.data[i] > 0.5f;
  std::vector<Piece> pieces;
  for (uint32_t start = 0; start < open.size(); ++start) {
    if (!open[start]) continue;
    Piece piece{start};
    open[start] = 0;
    for (size_t next = 0; next < piece.size(); ++next) {
      const int x = int(piece[next]) % mask.width, y = int(piece[next]) / mask.width;
      const auto visit = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= mask.width || j >= mask.height) return;
        const auto at = uint32_t(j) * uint32_t(mask.width) + uint32_t(i);
        if (open[at]) open[at] = 0, piece.push_back(at);
      };
      visit(x - 1, y), visit(x + 1, y), visit(x, y - 1), visit(x, y + 1);
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

// Removes mask pixels outside of the consensus.
void keep_near(Image& mask, const View& view, const Camera& small, const Area& area) {
  const Area near = dilated(area, small.width, small.height, 2);
  const double n = double(view.camera.width) / small.width;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const Vec2d pixel{x + 0.5, y + 0.5};
      const std::optional<Vec2d> at =
          view.photo ? pinhole_from_photo(*view.photo, view.camera, pixel) : std::optional(pixel);
      const int i = at ? int(std::floor(at->x / n)) : -1, j = at ? int(std::floor(at->y / n)) : -1;
      const bool inside = i >= 0 && j >= 0 && i < small.width && j < small.height;
      if (!inside || !near[size_t(j) * small.width + i]) *mask.at(x, y) = 0;
    }
}

// Removes pieces that are small in comparison with the largest one.
void drop_specks(Image& mask) {
  constexpr double kSpeck = 0.03;  // share of the largest piece
  const std::vector<Piece> pieces = pieces_of(mask);
  size_t largest = 0;
  for (const Piece& p : pieces) largest = std::max(largest, p.size());
  for (const Piece& p : pieces)
    if (double(p.size()) < kSpeck * double(largest))
      for (const uint32_t i : p) mask.data[i] = 0;
}

bool second_mask(const MaskRequest& r, size_t v, const Consensus& consensus, PhotoSegmenter& segmenter) {
  const View& view = r.views[v];
  const fs::path file = r.masks / (view.name + ".png");
  if (fs::exists(file)) return true;
  const PhotoArea area = photo_area(view, consensus.cameras[v], consensus.areas[v]);
  if (area.box.width < 8 || area.box.height < 8) return false;
  Prompts prompts;
  BelievedPixels in_box = area.pixels;
  std::erase_if(in_box.out, [&](Vec2f p) {
    return p.x < float(area.box.x0) || p.y < float(area.box.y0) ||
           p.x >= float(area.box.x0 + area.box.width) || p.y >= float(area.box.y0 + area.box.height);
  });
  add_prompts(in_box, kBesideObject, prompts);
  prompts.positive.resize(std::min(prompts.positive.size(), kOnObject));
  Image mask = mask_image(segmenter.log_odds(view, area.box, prompts, area.object), area.box, view);
  keep_near(mask, view, consensus.cameras[v], consensus.areas[v]);
  drop_specks(mask);
  write_png(file, mask);
  return true;
}

}  // namespace

std::vector<std::string> make_masks(const MaskRequest& r, PhotoSegmenter& segmenter, double first,
                                    double last, Progress& progress) {
  const SparsePoints points = sparse_points(r.views);
  const double middle = (first + last) / 2;
  const PointBelief belief = make_first_masks(r, points, segmenter, first, middle, progress);
  const Consensus consensus = agree(r, ball_of(points, belief));
  std::vector<std::string> without;
  for (size_t v = 0; v < r.views.size(); ++v) {
    check_cancelled(progress, "Interrupted; the same command goes on from here.");
    progress.report({"masks", middle + (last - middle) * double(v) / double(r.views.size()), -1, ""});
    if (!second_mask(r, v, consensus, segmenter)) without.push_back(r.views[v].name);
  }
  return without;
}

}  // namespace cei3d

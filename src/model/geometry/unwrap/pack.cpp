// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/pack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/mirror.h"
#include "model/geometry/unwrap/outline.h"
#include "model/geometry/unwrap/place.h"

namespace cei3d {
namespace {

struct Box {
  Vec2d low{1e300, 1e300}, high{-1e300, -1e300};
  Vec2d size() const { return high - low; }
};

Box box_of(std::span<const Vec2d> points) {
  Box b;
  for (const Vec2d& p : points) {
    b.low = {std::min(b.low.x, p.x), std::min(b.low.y, p.y)};
    b.high = {std::max(b.high.x, p.x), std::max(b.high.y, p.y)};
  }
  return b;
}

Vec2d turned(Vec2d p, double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

// Turned so that the lower left corner of its box is the origin.
std::vector<Vec2d> turned_to_origin(std::vector<Vec2d> points, double radians) {
  for (Vec2d& p : points) p = turned(p, radians);
  const Box b = box_of(points);
  for (Vec2d& p : points) p = p - b.low;
  return points;
}

// By which turn the points get into the smallest box that lies along an edge of their hull, wider than high.
double smallest_box(const std::vector<Vec2d>& points) {
  const std::vector<Vec2d> hull = convex_hull(points);
  double best = 1e300, angle = 0;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const double a = -std::atan2(edge.y, edge.x);
    std::vector<Vec2d> t = hull;
    for (Vec2d& p : t) p = turned(p, a);
    const Vec2d size = box_of(t).size();
    if (size.x * size.y < best) best = size.x * size.y, angle = size.x < size.y ? a + kPi / 2 : a;
  }
  return angle;
}

// All cells that a triangle touches, row by row: its part in a row reaches from its leftmost to its rightmost
// point there.
void cover(BitGrid& grid, const std::array<Vec2d, 3>& t) {
  const Box b = box_of(t);
  const int y0 = std::clamp(int(b.low.y), 0, grid.height() - 1),
            y1 = std::clamp(int(b.high.y), 0, grid.height() - 1);
  for (int y = y0; y <= y1; ++y) {
    double left = 1e300, right = -1e300;
    const auto reach = [&](double x) { left = std::min(left, x), right = std::max(right, x); };
    for (int k = 0; k < 3; ++k) {
      const Vec2d p = t[k], q = t[(k + 1) % 3];
      if (p.y >= y && p.y <= y + 1) reach(p.x);
      for (const double border : {double(y), y + 1.0})
        if ((p.y - border) * (q.y - border) < 0) reach(p.x + (q.x - p.x) * (border - p.y) / (q.y - p.y));
    }
    if (left > right) continue;
    const int x1 = std::clamp(int(right), 0, grid.width() - 1);
    for (int x = std::clamp(int(left), 0, grid.width() - 1); x <= x1; ++x) grid.set(x, y);
  }
}

// Turned by quarters, counter-clockwise, within its box.
Vec2d quarter_turned(Vec2d p, Vec2d size, int quarters) {
  for (; quarters > 0; --quarters) {
    p = {size.y - p.y, p.x};
    size = {size.y, size.x};
  }
  return p;
}

BitGrid turned_once(const BitGrid& g) {
  BitGrid out(g.height(), g.width());
  for (int y = 0; y < g.height(); ++y)
    for (int x = 0; x < g.width(); ++x)
      if (g.at(x, y)) out.set(g.height() - 1 - y, x);
  return out;
}

// A piece turned in one way; quarter turns are made on its cells.
struct Pose {
  std::vector<Vec2d> points;
  Vec2d size;
};

// Number of rotations that are tried besides quarter turns: pieces that fill their boxes badly often fit
// better rotated.
constexpr int kPoses = 3;

struct Placement {
  int x, y, pose, quarters;
};

// The grid that pieces are placed in: `between` texels are kMargin cells.
constexpr int kMargin = 4;

struct Packing {
  double scale;  // cells per unit of length
  std::vector<Placement> of_piece;
};

class Packer {
 public:
  Packer(std::span<const FlatPiece> pieces, const PackOptions& o)
      : flat_(pieces), cells_(o.size * kMargin / o.between), pieces_(pieces.size()) {
    parallel_for(int(pieces.size()), [&](int i) {
      const double best = smallest_box(pieces[i].points);
      for (int k = 0; k < kPoses; ++k) {
        Pose& pose = pieces_[i][k];
        pose.points = turned_to_origin(pieces[i].points, best + kPi / 2 * k / kPoses);
        pose.size = box_of(pose.points).size();
      }
    });
    add_order([](Vec2d size) { return std::max(size.x, size.y); });
    add_order([](Vec2d size) { return size.x * size.y; });
    add_order([](Vec2d size) { return std::min(size.x, size.y); });
  }

  // The largest scale, up to kNear, at which all pieces find a place in one of the orders.
  Packing best(double total_area) const {
    constexpr double kFirst = 0.7, kMax = 0.95, kMin = 0.01;  // shares of the area that is used
    constexpr double kNear = 1.01, kSmaller = 0.9;
    std::optional<Packing> best;
    double low = 0, high = kMax;
    for (double share = kFirst; !best || high / low > kNear;
         share = best ? std::sqrt(low * high) : kSmaller * share) {
      if (share < kMin)
        fail(
            "The surface falls into {} pieces, too many for the texture; export fewer faces or a larger "
            "texture.",
            pieces_.size());
      if (auto found = in_any_order(std::sqrt(share / total_area) * cells_))
        best = std::move(found), low = share;
      else
        high = share;
    }
    return std::move(*best);
  }

  std::vector<Vec2d> placed(const Packing& packing, size_t i) const {
    const Placement& at = packing.of_piece[i];
    const Pose& pose = pieces_[i][at.pose];
    const Vec2d box{double(width(pose.size.x, packing.scale)), double(width(pose.size.y, packing.scale))};
    std::vector<Vec2d> out;
    for (const Vec2d& p : pose.points) {
      const Vec2d q = quarter_turned(p * packing.scale, box, at.quarters);
      out.push_back(Vec2d{q.x + at.x + 1, q.y + at.y + 1} * (1.0 / cells_));
    }
    return out;
  }

 private:
  static int width(double length, double scale) { return std::max(1, int(std::ceil(length * scale))); }

  // The largest pieces first, by a measure of their boxes.
  template <class Measure>
  void add_order(const Measure& measure) {
    std::vector<size_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), size_t(0));
    const auto rank = [&](size_t i) { return measure(pieces_[i][0].size); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rank(a) > rank(b); });
    orders_.push_back(std::move(order));
  }

  BitGrid cells_of(size_t i, const Pose& pose, double scale) const {
    BitGrid grid(width(pose.size.x, scale), width(pose.size.y, scale));
    for (const auto& [a, b, c] : flat_[i].triangles)
      cover(grid, {pose.points[a] * scale, pose.points[b] * scale, pose.points[c] * scale});
    return grid;
  }

  // The footprints of a piece in all poses, each turned by all quarters.
  using Footprints = std::array<Footprint, kPoses * 4>;

  std::vector<Footprints> footprints_at(double scale) const {
    std::vector<Footprints> out(pieces_.size());
    parallel_for(int(out.size()), [&](int i) {
      for (int k = 0; k < kPoses; ++k) {
        BitGrid grid = cells_of(size_t(i), pieces_[i][k], scale);
        for (int quarters = 0; quarters < 4; ++quarters) {
          if (quarters > 0) grid = turned_once(grid);
          out[i][k * 4 + quarters] = footprint_of(grid);
        }
      }
    });
    return out;
  }

  std::optional<Packing> in_any_order(double scale) const {
    std::vector<std::optional<Packing>> found(orders_.size());
    const std::vector<Footprints> prints = footprints_at(scale);
    parallel_for(int(found.size()), [&](int k) { found[k] = attempt(scale, prints, orders_[k]); });
    for (auto& f : found)
      if (f) return std::move(f);
    return std::nullopt;
  }

  std::optional<Packing> attempt(double scale, const std::vector<Footprints>& prints,
                                 const std::vector<size_t>& order) const {
    const int inner = cells_ - 2;  // a cell along the rim stays free
    Taken taken(BitGrid(inner, inner));
    Packing out{scale, std::vector<Placement>(pieces_.size())};
    for (const size_t i : order) {
      const auto at = place(prints[i], taken);
      if (!at) return std::nullopt;
      out.of_piece[i] = *at;
    }
    return out;
  }

  // Where its top is the lowest.
  static std::optional<Placement> place(const Footprints& prints, Taken& taken) {
    std::optional<Placement> best;
    int top = taken.cells().height() + 1;
    for (int k = 0; k < int(prints.size()); ++k) {
      const auto at = taken.lowest_place(prints[k], top - prints[k].height);
      if (!at) continue;
      best = Placement{at->x, at->y, k / 4, k % 4};
      top = at->y + prints[k].height;
    }
    if (best) taken.take(prints[best->pose * 4 + best->quarters], {best->x, best->y}, kMargin);
    return best;
  }

  std::span<const FlatPiece> flat_;
  int cells_;
  std::vector<std::array<Pose, kPoses>> pieces_;
  std::vector<std::vector<size_t>> orders_;
};

}  // namespace

std::vector<std::vector<Vec2d>> packed(std::span<const FlatPiece> pieces, const PackOptions& options) {
  double area = 0;
  for (const FlatPiece& piece : pieces) area += area_of(piece);
  if (!(area > 0)) fail("The surface has no area that a texture could cover.");
  const Packer packer(pieces, options);
  const Packing packing = packer.best(area);
  std::vector<std::vector<Vec2d>> out;
  for (size_t i = 0; i < pieces.size(); ++i) out.push_back(packer.placed(packing, i));
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/pack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/mirror.h"
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

// The convex hull, counter-clockwise. [Andrew 1979]
std::vector<Vec2d> hull_of(std::vector<Vec2d> p) {
  std::sort(p.begin(), p.end(), [](Vec2d a, Vec2d b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2d> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t start = hull.size();
    for (const Vec2d& q : p) {
      while (hull.size() >= start + 2 &&
             signed_area(hull.back() - hull[hull.size() - 2], q - hull[hull.size() - 2]) <= 0)
        hull.pop_back();
      hull.push_back(q);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(p.begin(), p.end());
  }
  return hull;
}

// Into the smallest box that lies along an edge of the hull, wider than high; its corner in the origin.
std::vector<Vec2d> boxed(std::vector<Vec2d> points) {
  const std::vector<Vec2d> hull = hull_of(points);
  double best = 1e300, angle = 0;
  for (size_t i = 0; i < hull.size(); ++i) {
    const Vec2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const double a = -std::atan2(edge.y, edge.x);
    std::vector<Vec2d> t = hull;
    for (Vec2d& p : t) p = turned(p, a);
    const Vec2d size = box_of(t).size();
    if (size.x * size.y < best) best = size.x * size.y, angle = size.x < size.y ? a + kPi / 2 : a;
  }
  for (Vec2d& p : points) p = turned(p, angle);
  const Box b = box_of(points);
  for (Vec2d& p : points) p = p - b.low;
  return points;
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

struct Piece {
  std::vector<Vec2d> points;  // boxed
  Vec2d size;
  double area;
};

struct Placement {
  int x, y, quarters;
};

// The grid that pieces are placed in: `between` texels are kMargin cells.
constexpr int kMargin = 2;

struct Packing {
  double scale;  // cells per unit of length
  std::vector<Placement> of_piece;
};

class Packer {
 public:
  Packer(std::span<const FlatPiece> pieces, const PackOptions& o)
      : flat_(pieces), cells_(o.size * kMargin / o.between), pieces_(pieces.size()), order_(pieces.size()) {
    parallel_for(int(pieces.size()), [&](int i) {
      std::vector<Vec2d> p = boxed(pieces[i].points);
      const Vec2d size = box_of(p).size();
      pieces_[i] = {std::move(p), size, size.x * size.y};
    });
    std::iota(order_.begin(), order_.end(), size_t(0));
    const auto rank = [&](size_t i) { return std::max(pieces_[i].size.x, pieces_[i].size.y); };
    std::stable_sort(order_.begin(), order_.end(), [&](size_t a, size_t b) { return rank(a) > rank(b); });
  }

  // The largest of a row of scales at which all pieces find a place.
  Packing best(double total_area) const {
    constexpr double kMost = 0.94, kFactor = 0.985;  // share of the area that is used, and between attempts
    constexpr int kAtOnce = 4, kAttempts = 400;
    for (int i = 0; i < kAttempts; i += kAtOnce) {
      std::vector<std::optional<Packing>> found(kAtOnce);
      parallel_for(kAtOnce, [&](int k) {
        const double share = kMost * std::pow(kFactor, i + k);
        found[k] = attempt(std::sqrt(share / total_area) * cells_);
      });
      for (auto& f : found)
        if (f) return std::move(*f);
    }
    fail(
        "The surface falls into {} pieces, too many for the texture; export fewer faces or a larger texture.",
        pieces_.size());
  }

  std::vector<Vec2d> placed(const Packing& packing, size_t i) const {
    const Piece& piece = pieces_[i];
    const Placement& at = packing.of_piece[i];
    const BitGrid cells(width(piece.size.x, packing.scale), width(piece.size.y, packing.scale));
    const Vec2d box{double(cells.width()), double(cells.height())};
    std::vector<Vec2d> out;
    for (const Vec2d& p : piece.points) {
      const Vec2d q = quarter_turned(p * packing.scale, box, at.quarters);
      out.push_back(Vec2d{q.x + at.x + 1, q.y + at.y + 1} * (1.0 / cells_));
    }
    return out;
  }

 private:
  static int width(double length, double scale) { return std::max(1, int(std::ceil(length * scale))); }

  BitGrid cells_of(size_t i, double scale) const {
    BitGrid grid(width(pieces_[i].size.x, scale), width(pieces_[i].size.y, scale));
    for (const auto& [a, b, c] : flat_[i].triangles) {
      const auto& p = pieces_[i].points;
      cover(grid, {p[a] * scale, p[b] * scale, p[c] * scale});
    }
    return grid;
  }

  std::optional<Packing> attempt(double scale) const {
    const int inner = cells_ - 2;  // a cell along the rim stays free
    BitGrid taken(inner, inner);
    Packing out{scale, std::vector<Placement>(pieces_.size())};
    for (const size_t i : order_) {
      BitGrid grid = cells_of(i, scale);
      std::optional<Placement> best;
      Footprint best_piece;
      int top = inner + 1;
      for (int quarters = 0; quarters < 4; ++quarters) {
        if (quarters > 0) grid = turned_once(grid);
        Footprint piece = footprint_of(grid);
        const auto at = lowest_place(taken, piece, top - piece.height);
        if (!at) continue;
        best = Placement{at->x, at->y, quarters};
        top = at->y + piece.height;
        best_piece = std::move(piece);
      }
      if (!best) return std::nullopt;
      take(taken, best_piece, {best->x, best->y}, kMargin);
      out.of_piece[i] = *best;
    }
    return out;
  }

  std::span<const FlatPiece> flat_;
  int cells_;
  std::vector<Piece> pieces_;
  std::vector<size_t> order_;
};

double area_of(std::span<const FlatPiece> pieces) {
  double sum = 0;
  for (const FlatPiece& piece : pieces)
    for (const auto& [a, b, c] : piece.triangles) {
      const auto& p = piece.points;
      sum += std::abs(signed_area(p[b] - p[a], p[c] - p[a])) / 2;
    }
  return sum;
}

}  // namespace

std::vector<std::vector<Vec2d>> packed(std::span<const FlatPiece> pieces, const PackOptions& options) {
  const double area = area_of(pieces);
  if (!(area > 0)) fail("The surface has no area that a texture could cover.");
  const Packer packer(pieces, options);
  const Packing packing = packer.best(area);
  std::vector<std::vector<Vec2d>> out;
  for (size_t i = 0; i < pieces.size(); ++i) out.push_back(packer.placed(packing, i));
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/align_view.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/bilinear.h"
#include "core/math/loss.h"

namespace cei3d {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int kRim = 3;                // pixels around the model that take part, at the depth of its edge
constexpr std::array kBlurs{2, 1, 0};  // radii in pixels, one after the other
constexpr double kHuber = 0.1;         // sRGB; larger differences weigh less
constexpr double kSmallStep = 0.003;   // pixels; a smaller step is the last one
// Pixels beside each other show the same thing: so many count as one against the expected motions.
constexpr double kPixelsThatAgree = 30;

struct Point {
  Vec3d at;
  int x, y;  // pixel of the model
};

// Depths of the model, continued by one pixel where there is none.
Image grown(const Image& depth) {
  Image out = depth;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      if (*depth.at(x, y) > 0) continue;
      float sum = 0;
      int n = 0;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, depth.height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, depth.width - 1); ++i)
          if (*depth.at(i, j) > 0) sum += *depth.at(i, j), ++n;
      if (n > 0) *out.at(x, y) = sum / float(n);
    }
  return out;
}

// With a rim, so that silhouettes pull from both sides.
std::vector<Point> points_of(const Camera& camera, const ModelView& model) {
  Image depth = model.depth;
  for (int i = 0; i < kRim; ++i) depth = grown(depth);
  std::vector<Point> points;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (*depth.at(x, y) > 0) {
        const Ray ray = camera.ray(x + 0.5, y + 0.5);
        points.push_back({to_double(ray.origin + ray.direction * *depth.at(x, y)), x, y});
      }
  return points;
}

// Mean over a square of 2 radius + 1 pixels; pixels beyond the edge are those of the edge.
Image blurred(const Image& image, int radius) {
  Image out(image.width, image.height, image.channels);
  const float share = 1.0f / float((2 * radius + 1) * (2 * radius + 1));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
          const float* p =
              image.at(std::clamp(x + i, 0, image.width - 1), std::clamp(y + j, 0, image.height - 1));
          for (int c = 0; c < image.channels; ++c) out.at(x, y)[c] += share * p[c];
        }
  return out;
}

struct Sampled {
  Vec3d color, d_x, d_y;  // and its derivatives by the position, in pixels
  double known;
};

// Bilinear at a continuous position, with the derivatives of the same interpolation.
Sampled sample(const Image& image, double u, double v) {
  const double x = std::clamp(u - 0.5, 0.0, image.width - 1.001),
               y = std::clamp(v - 0.5, 0.0, image.height - 1.001);
  const int i = int(x), j = int(y);
  const double fx = x - i, fy = y - j;
  const float *a = image.at(i, j), *b = image.at(i + 1, j), *c = image.at(i, j + 1),
              *d = image.at(i + 1, j + 1);
  Sampled s;
  const auto channel = [&](int k) { return SquareCorners<double>{a[k], b[k], c[k], d[k]}; };
  for (int k = 0; k < 3; ++k) {
    s.color[k] = bilinear(channel(k), fx, fy);
    s.d_x[k] = bilinear_d_x(channel(k), fy);
    s.d_y[k] = bilinear_d_y(channel(k), fx);
  }
  s.known = image.channels > 3 ? bilinear(channel(3), fx, fy) : 1;
  return s;
}

Vector6 vector_of(Vec3d turn, Vec3d shift) { return {turn.x, turn.y, turn.z, shift.x, shift.y, shift.z}; }

// The normal equations of all points at the present camera.
struct Equations {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double squares = 0, weight = 0;  // of the color differences
};

void add_point(const Camera& camera, const Point& p, const Image& model, const Image& photograph,
               Equations& e) {
  const Vec3d at = camera.project(p.at);
  const auto inside = [](double u, int size) { return u > 0.5 && u < size - 0.5; };
  if (at.z <= 0 || !inside(at.x, photograph.width) || !inside(at.y, photograph.height)) return;
  const Sampled shown = sample(photograph, at.x, at.y), rendered = sample(model, p.x + 0.5, p.y + 0.5);
  if (shown.known < 0.999) return;
  const MotionGrad grad = motion_grad(camera, p.at);
  const Vector6 x = vector_of(grad.d_turn[0], grad.d_shift[0]),
                y = vector_of(grad.d_turn[1], grad.d_shift[1]);
  for (int c = 0; c < 3; ++c) {
    const double r = shown.color[c] - rendered.color[c], w = huber_weight(r, kHuber);
    // The mean gradient of both images: the step is then right to second order [Malis 2004].
    const Vector6 row =
        0.5 * (shown.d_x[c] + rendered.d_x[c]) * x + 0.5 * (shown.d_y[c] + rendered.d_y[c]) * y;
    e.matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    e.right -= w * r * row;
    e.squares += w * r * r;
    e.weight += w;
  }
}

// The step that leaves the least, given what was moved so far.
Vector6 step_of(Equations e, const Vector6& so_far, const AlignOptions& o) {
  const double noise = kPixelsThatAgree * (e.squares / std::max(e.weight, 1.0) + 1e-6);
  for (int i = 0; i < 6; ++i) {
    const double prior = noise / (i < 3 ? o.turn * o.turn : o.shift * o.shift);
    e.matrix(i, i) += prior;
    e.right(i) -= prior * so_far(i);
  }
  return e.matrix.selfadjointView<Eigen::Lower>().ldlt().solve(e.right);
}

double mean_way(const Camera& from, const Camera& to, const std::vector<Point>& points) {
  double sum = 0;
  for (const Point& p : points) {
    const Vec3d a = from.project(p.at), b = to.project(p.at);
    sum += (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
  }
  return std::sqrt(sum / double(std::max<size_t>(points.size(), 1)));
}

RigidMotion motion_of(const Vector6& v) { return {{v(0), v(1), v(2)}, {v(3), v(4), v(5)}}; }

}  // namespace

MotionInformation information_of(const Camera& camera, std::span<const Vec3d> points) {
  MotionInformation sum{};
  for (const Vec3d p : points) {
    const MotionGrad grad = motion_grad(camera, p);
    for (int k = 0; k < 2; ++k) {
      const Vector6 row = vector_of(grad.d_turn[k], grad.d_shift[k]);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) sum[size_t(i)][size_t(j)] += row(i) * row(j);
    }
  }
  return sum;
}

Alignment align_view(const Camera& given, const ModelView& model, const Image& photograph,
                     const AlignOptions& options) {
  const std::vector<Point> points = points_of(given, model);
  Camera camera = given;
  for (const int blur : kBlurs) {
    const Image rendered = blurred(model.srgb, blur), shown = blurred(photograph, blur);
    for (int i = 0; i < options.steps; ++i) {
      Equations e;
      for (const Point& p : points) add_point(camera, p, rendered, shown, e);
      const RigidMotion so_far = motion_between(given, camera);
      const Camera next = moved(camera, motion_of(step_of(e, vector_of(so_far.turn, so_far.shift), options)));
      const double way = mean_way(camera, next, points);
      camera = next;
      if (way < kSmallStep) break;
    }
  }
  std::vector<Vec3d> positions;
  for (const Point& p : points) positions.push_back(p.at);
  return {motion_between(given, camera), mean_way(given, camera, points), information_of(given, positions)};
}

}  // namespace cei3d

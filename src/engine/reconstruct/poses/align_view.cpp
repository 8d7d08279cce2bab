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

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;
using Vector6 = Vector<6>;

constexpr int kRim = 3;                // pixels around the model that take part, at the depth of its edge
constexpr std::array kBlurs{2, 1, 0};  // radii in pixels, one after the other
constexpr double kHuber = 0.1;         // sRGB; larger differences weigh less
constexpr double kSmallStep = 0.003;   // pixels; a smaller step is the last one
// Pixels beside each other show the same thing: so many count as one against the expected motions.
constexpr double kPixelsThatAgree = 30;

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
  Vec3d color, d_x, d_y;  // color, and its derivatives by x and y per pixel
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

RigidMotion motion_of(const Vector6& v) { return {{v(0), v(1), v(2)}, {v(3), v(4), v(5)}}; }

// Derivatives of the pixel position of a point, x and y, by a motion of the camera; of seven, the last by a
// change of the focal length.
template <int N>
std::array<Vector<N>, 2> pixel_jacobian(const Camera& camera, Vec3d point) {
  const MotionGrad grad = motion_grad(camera, point);
  std::array<Vector<N>, 2> out;
  for (size_t k = 0; k < 2; ++k) out[k].template head<6>() = vector_of(grad.d_turn[k], grad.d_shift[k]);
  if constexpr (N == 7) {
    const Vec2d zoom = dolly_zoom_grad(camera, point);
    out[0](6) = zoom.x;
    out[1](6) = zoom.y;
  }
  return out;
}

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

// The normal equations of all points at the present camera. Of the matrix the lower half.
template <int N>
struct ViewAligner::Equations {
  Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Zero();
  Vector<N> right = Vector<N>::Zero();
  double squares = 0, weight = 0;  // of the color differences
};

ViewAligner::ViewAligner(const Camera& given, const ModelView& model, const Image& photograph,
                         const AlignOptions& options)
    : given_(given), camera_(given), model_(model), photograph_(photograph), options_(options) {}

// With a rim, so that silhouettes pull from both sides.
std::vector<ViewAligner::Point> ViewAligner::points_of_model() const {
  Image depth = model_.depth;
  for (int i = 0; i < kRim; ++i) depth = grown(depth);
  std::vector<Point> points;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (*depth.at(x, y) > 0) {
        const Ray ray = given_.ray(x + 0.5, y + 0.5);
        points.push_back({ray.origin + ray.direction * *depth.at(x, y), uint16_t(x), uint16_t(y)});
      }
  return points;
}

template <int N>
void ViewAligner::add_point(const Point& p, const Image& rendered_image, const Image& shown_image,
                            Equations<N>& e) const {
  const Vec3d point = to_double(p.at), at = camera_.project(point);
  const auto inside = [](double u, int size) { return u > 0.5 && u < size - 0.5; };
  if (at.z <= 0 || !inside(at.x, shown_image.width) || !inside(at.y, shown_image.height)) return;
  const Sampled shown = sample(shown_image, at.x, at.y),
                rendered = sample(rendered_image, p.x + 0.5, p.y + 0.5);
  if (shown.known < 0.999) return;
  const std::array<Vector<N>, 2> jacobian = pixel_jacobian<N>(camera_, point);
  for (int c = 0; c < 3; ++c) {
    const double r = shown.color[c] - rendered.color[c], w = huber_weight(r, kHuber);
    // The mean gradient of both images: the step is then right to second order [Malis 2004].
    const Vector<N> row = 0.5 * (shown.d_x[c] + rendered.d_x[c]) * jacobian[0] +
                          0.5 * (shown.d_y[c] + rendered.d_y[c]) * jacobian[1];
    e.matrix.template selfadjointView<Eigen::Lower>().rankUpdate(row, w);
    e.right -= w * r * row;
    e.squares += w * r * r;
    e.weight += w;
  }
}

template <int N>
ViewAligner::Equations<N> ViewAligner::equations(const Image& rendered, const Image& shown) const {
  Equations<N> e;
  for (const Point& p : points_) add_point(p, rendered, shown, e);
  return e;
}

// Adds what is expected of the motion, given what was moved so far, and returns the variance of what the
// equations are made of. A change of the focal length costs nothing here, nor does the way that
// dolly_zoomed() goes with it: that is common to all views, which cannot know the size of the object.
template <int N>
double ViewAligner::add_prior(Equations<N>& e) const {
  const RigidMotion moved_by = motion_between(dolly_zoomed(given_, std::exp(log_focal_)), camera_);
  const Vector6 so_far = vector_of(moved_by.turn, moved_by.shift);
  const double noise = kPixelsThatAgree * (e.squares / std::max(e.weight, 1.0) + 1e-6);
  for (int i = 0; i < 6; ++i) {
    const double expected = i < 3 ? options_.turn : options_.shift, prior = noise / (expected * expected);
    e.matrix(i, i) += prior;
    e.right(i) -= prior * so_far(i);
  }
  return noise;
}

// Root mean square over the points of how far their images are apart.
double ViewAligner::mean_way(const Camera& from, const Camera& to) const {
  double sum = 0;
  for (const Point& p : points_) {
    const Vec3d a = from.project(to_double(p.at)), b = to.project(to_double(p.at));
    sum += (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
  }
  return std::sqrt(sum / double(std::max<size_t>(points_.size(), 1)));
}

void ViewAligner::align_pose() {
  points_ = points_of_model();
  for (const int blur : kBlurs) {
    const Image rendered = blurred(model_.srgb, blur), shown = blurred(photograph_, blur);
    for (int i = 0; i < options_.steps; ++i) {
      Equations<6> e = equations<6>(rendered, shown);
      add_prior(e);
      const Vector6 step = e.matrix.selfadjointView<Eigen::Lower>().ldlt().solve(e.right);
      const Camera next = moved(camera_, motion_of(step));
      const double way = mean_way(camera_, next);
      camera_ = next;
      if (way < kSmallStep) break;
    }
  }
}

// Eliminates the motion from the equations: the Schur complement.
FocalPull ViewAligner::focal_pull() {
  Equations<7> e = equations<7>(model_.srgb, photograph_);
  const double noise = add_prior(e);
  const Eigen::Matrix<double, 6, 6> of_motion =
      e.matrix.topLeftCorner<6, 6>().selfadjointView<Eigen::Lower>();
  const Vector6 mixed = e.matrix.row(6).head<6>().transpose(), right = e.right.head<6>();
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(of_motion);
  const Vector6 still = solver.solve(right), follow = solver.solve(mixed);
  std::copy_n(still.data(), 6, still_.begin());
  std::copy_n(follow.data(), 6, follow_.begin());
  return {(e.matrix(6, 6) - mixed.dot(follow)) / noise, (e.right(6) - mixed.dot(still)) / noise};
}

void ViewAligner::zoom(double change) {
  Vector6 motion;
  for (int i = 0; i < 6; ++i) motion(i) = still_[size_t(i)] - change * follow_[size_t(i)];
  camera_ = moved(dolly_zoomed(camera_, std::exp(change)), motion_of(motion));
  log_focal_ += change;
}

Alignment ViewAligner::alignment() const {
  std::vector<Vec3d> positions;
  for (const Point& p : points_) positions.push_back(to_double(p.at));
  return {motion_between(dolly_zoomed(given_, std::exp(log_focal_)), camera_), mean_way(given_, camera_),
          information_of(given_, positions)};
}

Alignment align_view(const Camera& given, const ModelView& model, const Image& photograph,
                     const AlignOptions& options) {
  ViewAligner view(given, model, photograph, options);
  view.align_pose();
  return view.alignment();
}

}  // namespace cei3d

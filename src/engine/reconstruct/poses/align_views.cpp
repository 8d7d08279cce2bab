// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/align_views.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/image/area.h"
#include "core/image/exposure.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/poses/align_view.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

// Maximum number of steps of the focal length. A step is the last if it changes the logarithm by less than
// kSmallChange, or by less than kSmallShare of its standard error.
constexpr int kFocalSteps = 20;
constexpr double kSmallChange = 1e-5, kSmallShare = 0.1;
// A change is used if it exceeds kSureErrors standard errors and kMinChange: that is a sixth of a pixel in
// views of 800 pixels, and smaller changes are mostly errors of the short training. Beyond kMaxDeviations
// standard deviations of the prior it is rejected, because focal lengths are not that wrong.
constexpr double kSureErrors = 3, kMinChange = 0.004, kMaxDeviations = 5;

// The best step by views and prior, and its standard error.
struct FocalStep {
  double change, error;
};
FocalStep focal_step(std::span<const FocalPull> views, const FocalPrior& prior, double so_far) {
  const double of_prior = 1 / (prior.error * prior.error);
  double information = of_prior, pull = -of_prior * (std::log(prior.found) + so_far), squares = 0;
  for (const FocalPull& v : views) {
    information += v.information;
    pull += v.pull;
    squares += v.pull * v.pull;
  }
  // The standard error follows from how much the views disagree, or if that is less, from the differences of
  // colors within them.
  return {pull / information, std::max(std::sqrt(squares) / information, 1 / std::sqrt(information))};
}

}  // namespace

double change_focal(std::span<ViewAligner> views, const FocalPrior& prior) {
  std::vector<FocalPull> pulls(views.size());
  double change = 0;
  for (int i = 0; i < kFocalSteps; ++i) {
    parallel_for(int(views.size()), [&](int v) { pulls[size_t(v)] = views[size_t(v)].focal_pull(); });
    const FocalStep step = focal_step(pulls, prior, change);
    change += step.change;
    if (!(std::abs(change) < kMaxDeviations * prior.error)) return 0;
    for (ViewAligner& v : views) v.zoom(step.change);
    if (std::abs(step.change) > std::max(kSmallChange, kSmallShare * step.error)) continue;
    return std::abs(change) < std::max(kSureErrors * step.error, kMinChange) ? 0 : change;
  }
  return 0;
}

void keep_frame(std::span<const Camera> cameras, std::vector<Alignment>& views) {
  Matrix7 matrix = Matrix7::Identity() * 1e-9;
  Vector7 right = Vector7::Zero();
  for (size_t v = 0; v < views.size(); ++v) {
    const RigidMotion& m = views[v].motion;
    const Vec3d c = cameras[v].center;
    // Derivative of the view's six numbers by those of the common motion; the last one is a step along its
    // center.
    Eigen::Matrix<double, 6, 7> d_common = Eigen::Matrix<double, 6, 7>::Zero();
    d_common.leftCols<6>().setIdentity();
    d_common.col(6) << 0, 0, 0, c.x, c.y, c.z;
    Eigen::Matrix<double, 6, 6> weight;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) weight(i, j) = views[v].information[size_t(i)][size_t(j)];
    Eigen::Matrix<double, 6, 1> own;
    own << m.turn.x, m.turn.y, m.turn.z, m.shift.x, m.shift.y, m.shift.z;
    matrix += d_common.transpose() * weight * d_common;
    right += d_common.transpose() * weight * own;
  }
  const Vector7 common = matrix.ldlt().solve(right);
  for (size_t v = 0; v < views.size(); ++v) {
    RigidMotion& m = views[v].motion;
    m.turn = m.turn - Vec3d{common(0), common(1), common(2)};
    m.shift = m.shift - Vec3d{common(3), common(4), common(5)} - cameras[v].center * common(6);
  }
}

std::vector<Image> photographs_over_white(const PixelStore& store, std::span<const int> n) {
  std::vector<Image> out;
  for (size_t v = 0; v < store.cameras().size(); ++v) {
    const Camera& whole = store.cameras()[v];
    const Camera small = scaled(whole, n[v]);
    Image image(small.width, small.height, 4, 1);
    for (int y = 0; y < small.height * n[v]; ++y)
      for (int x = 0; x < small.width * n[v]; ++x)
        if (store.masks()[v][size_t(y) * size_t(whole.width) + size_t(x)] == kUnknown)
          image.at(x / n[v], y / n[v])[3] = 0;
    out.push_back(std::move(image));
  }
  for (const Pixel& p : store.pixels()) {
    Image& image = out[p.view];
    const int k = n[p.view], x = p.x / k, y = p.y / k;
    if (x >= image.width || y >= image.height) continue;
    const Vec3f below_white = Vec3f{1, 1, 1} - store.target(p).srgb;
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] -= below_white[c] / float(k * k);
  }
  return out;
}

namespace {

std::vector<int> reductions_to(int side, const PixelStore& store) {
  std::vector<int> n;
  for (const Camera& c : store.cameras()) n.push_back((std::max(c.width, c.height) + side - 1) / side);
  return n;
}

}  // namespace

size_t pixels_shown(const PixelStore& store, int side) {
  const std::vector<int> n = reductions_to(side, store);
  size_t sum = 0;
  for (size_t v = 0; v < n.size(); ++v) {
    const Camera small = scaled(store.cameras()[v], n[v]);
    sum += size_t(small.width) * size_t(small.height);
  }
  return sum;
}

ShownViews show_views(GeometryStage& model, const PixelStore& store, int side, const Progress& progress) {
  ShownViews out;
  out.reductions = reductions_to(side, store);
  out.photographs = photographs_over_white(store, out.reductions);
  for (size_t v = 0; v < store.cameras().size(); ++v) {
    check_cancelled(progress);
    out.models.push_back(model.render_view(scaled(store.cameras()[v], out.reductions[v])));
  }
  return out;
}

AlignedViews align_views(const ShownViews& views, const PixelStore& store, const FocalPrior& prior) {
  const std::vector<Camera>& cameras = store.cameras();
  const std::vector<int>& n = views.reductions;
  std::vector<ViewAligner> aligners;
  aligners.reserve(cameras.size());
  for (size_t v = 0; v < cameras.size(); ++v)
    aligners.emplace_back(scaled(cameras[v], n[v]), views.models[v], views.photographs[v], AlignOptions());
  std::vector<Alignment> aligned(cameras.size());
  const auto note = [&](int v) { aligned[size_t(v)] = aligners[size_t(v)].alignment(); };
  parallel_for(int(cameras.size()), [&](int v) {
    aligners[size_t(v)].align_pose();
    note(v);
  });
  const double change = prior.error > 0 ? change_focal(aligners, prior) : 0;
  if (change != 0) parallel_for(int(cameras.size()), note);
  keep_frame(cameras, aligned);
  AlignedViews out;
  out.focal = std::exp(change);
  std::vector<double> pixels;
  for (size_t v = 0; v < cameras.size(); ++v) {
    out.cameras.push_back(moved(zoomed(cameras[v], out.focal), aligned[v].motion));
    pixels.push_back(aligned[v].pixels * n[v]);
  }
  out.pixels = median(pixels);
  return out;
}

namespace {

// Pixels well inside of the object in model and photograph.
Area inside_of(const ModelView& model, const Image& photograph) {
  Area inside(size_t(photograph.width) * photograph.height);
  for (size_t i = 0; i < inside.size(); ++i)
    inside[i] = model.depth.data[i] > 0 && !(photograph.data[4 * i + 3] < 0.999f);
  return eroded(inside, photograph.width, photograph.height, 1);
}

}  // namespace

std::vector<Vec3f> find_exposures(const ShownViews& views, const PixelStore& store) {
  std::vector<Vec3f> out = store.exposures();
  out.resize(views.models.size(), {1, 1, 1});
  Vec3d mean{0, 0, 0};
  for (size_t v = 0; v < out.size(); ++v) {
    const ModelView& model = views.models[v];
    if (const auto by =
            exposure_between(model.srgb, views.photographs[v], inside_of(model, views.photographs[v])))
      out[v] = out[v] * *by;
    for (int c = 0; c < 3; ++c) mean[c] += std::log(double(out[v][c])) / double(out.size());
  }
  for (Vec3f& factors : out)
    for (int c = 0; c < 3; ++c) factors[c] = float(factors[c] * std::exp(-mean[c]));
  return out;
}

double exposure_change(std::span<const Vec3f> a, std::span<const Vec3f> b) {
  const size_t n = std::max(a.size(), b.size());
  double sum = 0;
  for (size_t v = 0; v < n; ++v)
    for (int c = 0; c < 3; ++c) {
      const double from = a.empty() ? 1 : a[v][c], to = b.empty() ? 1 : b[v][c];
      sum += std::pow(std::log(to / from), 2) / double(3 * n);
    }
  return std::sqrt(sum);
}

}  // namespace cei3d

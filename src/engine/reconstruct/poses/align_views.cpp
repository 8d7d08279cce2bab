// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/align_views.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/poses/align_view.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

}  // namespace

void keep_frame(std::span<const Camera> cameras, std::vector<Alignment>& views) {
  Matrix7 matrix = Matrix7::Identity() * 1e-9;
  Vector7 right = Vector7::Zero();
  for (size_t v = 0; v < views.size(); ++v) {
    const RigidMotion& m = views[v].motion;
    const Vec3d c = cameras[v].center;
    // Of the view's six numbers by those of the common motion; the last one is a step along its center.
    Eigen::Matrix<double, 6, 7> by_common = Eigen::Matrix<double, 6, 7>::Zero();
    by_common.leftCols<6>().setIdentity();
    by_common.col(6) << 0, 0, 0, c.x, c.y, c.z;
    Eigen::Matrix<double, 6, 6> weight;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) weight(i, j) = views[v].information[size_t(i)][size_t(j)];
    Eigen::Matrix<double, 6, 1> own;
    own << m.turn.x, m.turn.y, m.turn.z, m.shift.x, m.shift.y, m.shift.z;
    matrix += by_common.transpose() * weight * by_common;
    right += by_common.transpose() * weight * own;
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
    const Vec3f below_white = Vec3f{1, 1, 1} - target_of(p).srgb;
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] -= below_white[c] / float(k * k);
  }
  return out;
}

AlignedViews align_views(GeometryStage& model, const PixelStore& store, int side, const Progress& progress) {
  const std::vector<Camera>& cameras = store.cameras();
  std::vector<int> n;
  for (const Camera& c : cameras) n.push_back((std::max(c.width, c.height) + side - 1) / side);
  const std::vector<Image> photographs = photographs_over_white(store, n);
  std::vector<ModelView> shown;
  for (size_t v = 0; v < cameras.size(); ++v) {
    check_cancelled(progress);
    shown.push_back(model.render_view(scaled(cameras[v], n[v])));
  }
  std::vector<Alignment> aligned(cameras.size());
  parallel_for(int(cameras.size()), [&](int v) {
    aligned[size_t(v)] =
        align_view(scaled(cameras[size_t(v)], n[size_t(v)]), shown[size_t(v)], photographs[size_t(v)]);
  });
  keep_frame(cameras, aligned);
  AlignedViews out;
  std::vector<double> pixels;
  for (size_t v = 0; v < cameras.size(); ++v) {
    out.cameras.push_back(moved(cameras[v], aligned[v].motion));
    pixels.push_back(aligned[v].pixels * n[v]);
  }
  out.pixels = median(pixels);
  return out;
}

}  // namespace cei3d

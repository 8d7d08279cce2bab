// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/poses/align_views.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/poses/align_view.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

RigidMotion mean_of(const std::vector<Alignment>& views) {
  RigidMotion mean;
  for (const Alignment& a : views) {
    mean.turn += a.motion.turn / double(views.size());
    mean.shift += a.motion.shift / double(views.size());
  }
  return mean;
}

}  // namespace

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
  const RigidMotion mean = mean_of(aligned);
  AlignedViews out;
  std::vector<double> pixels;
  for (size_t v = 0; v < cameras.size(); ++v) {
    const RigidMotion& m = aligned[v].motion;
    out.cameras.push_back(moved(cameras[v], {m.turn - mean.turn, m.shift - mean.shift}));
    pixels.push_back(aligned[v].pixels * n[v]);
  }
  out.pixels = median(pixels);
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/fid.h"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "engine/metrics/lpips.h"

namespace cei3d {
namespace {

// Mean of a set, and deviations of its images from it, divided by sqrt(n - 1): the covariance is X^T X.
struct Spread {
  Eigen::RowVectorXd mean;
  Eigen::MatrixXd x;  // #images x dimensions
};

Spread spread_of(const FeatureSet& s) {
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Spread out;
  out.x = Eigen::Map<const Rows>(s.rows.data(), Eigen::Index(s.size()), Eigen::Index(s.dimensions))
              .cast<double>();
  out.mean = out.x.colwise().mean();
  out.x.rowwise() -= out.mean;
  out.x /= std::sqrt(double(s.size() - 1));
  return out;
}

// The two pixels around a position, and the weight of the second.
struct Between {
  int first, second;
  float share;
};
Between between(int out, int out_size, int in_size) {
  const float at = (float(out) + 0.5f) * float(in_size) / float(out_size) - 0.5f;
  const float clamped = std::clamp(at, 0.0f, float(in_size - 1));
  const int first = int(clamped);
  return {first, std::min(first + 1, in_size - 1), clamped - float(first)};
}

}  // namespace

void FeatureSet::add(const std::vector<float>& row) {
  if (rows.empty()) dimensions = row.size();
  if (row.empty() || row.size() != dimensions)
    fail("The feature network gave {} numbers for one image and {} for another; it should be {} always.",
         dimensions, row.size(), dimensions);
  rows.insert(rows.end(), row.begin(), row.end());
}

FeatureNetwork::FeatureNetwork(std::shared_ptr<const OnnxRuntime> runtime, const std::filesystem::path& file,
                               int threads)
    : network_(std::move(runtime), file, threads), file_(file) {
  if (network_.inputs().size() != 1 || network_.outputs().empty())
    fail(
        "{} is not a network for FID: it has {} inputs, and one image goes in; see "
        "docs/evaluation.md.",
        file.string(), network_.inputs().size());
}

std::vector<float> FeatureNetwork::features(const Image& rgb) const {
  if (rgb.channels != 3 || rgb.empty())
    fail("Features are of images with three channels, not {}.", rgb.channels);
  const std::string& output = network_.outputs().front();
  const OnnxTensor input = image_tensor(resized_for_features(rgb, kSize, kSize), 1, 0);
  OnnxTensors out = network_.run({{network_.inputs().front(), input}}, {output});
  std::vector<float>& values = out.at(output).data;
  if (values.empty() || !std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
    fail("{} is not a network for FID: its features are not finite numbers; see docs/evaluation.md.",
         file_.string());
  return std::move(values);
}

Image resized_for_features(const Image& in, int width, int height) {
  Image out(width, height, in.channels);
  for (int y = 0; y < height; ++y) {
    const Between v = between(y, height, in.height);
    for (int x = 0; x < width; ++x) {
      const Between u = between(x, width, in.width);
      for (int c = 0; c < in.channels; ++c) {
        const float top = std::lerp(in.at(u.first, v.first)[c], in.at(u.second, v.first)[c], u.share);
        const float bottom = std::lerp(in.at(u.first, v.second)[c], in.at(u.second, v.second)[c], u.share);
        out.at(x, y)[c] = std::lerp(top, bottom, v.share);
      }
    }
  }
  return out;
}

double frechet_distance(const FeatureSet& a, const FeatureSet& b) {
  if (a.size() < 2 || b.size() < 2)
    fail("The Frechet distance (FID) needs at least two images in each set; there are {} and {}.", a.size(),
         b.size());
  if (a.dimensions != b.dimensions)
    fail("Features of {} and of {} numbers cannot be compared; both sets need the same network.",
         a.dimensions, b.dimensions);
  const Spread p = spread_of(a), q = spread_of(b);
  // tr (S1 S2)^(1/2) is the trace of the symmetric square root of S1^(1/2) S2 S1^(1/2); with S = X^T X its
  // eigenvalues are the singular values of X1 X2^T, a matrix as small as the sets.
  const Eigen::MatrixXd cross = p.x * q.x.transpose();
  const double root = Eigen::BDCSVD<Eigen::MatrixXd>(cross).singularValues().sum();
  const double d = (p.mean - q.mean).squaredNorm() + p.x.squaredNorm() + q.x.squaredNorm() - 2 * root;
  return std::max(d, 0.0);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr double kPi64 = std::numbers::pi;

// Linear sRGB to CIE XYZ, and the white point that it gives. [IEC 61966-2-1]
constexpr Vec3d kToXyz[3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr Vec3d kWhite{0.9504700, 1.0000001, 1.0888300};

// Constants of Andersson et al.: exponent of color differences; break of their scale and its value there;
// exponent of feature differences and width of features, in degrees.
constexpr double kColorExponent = 0.7, kBreak = 0.4, kAtBreak = 0.95, kFeatureExponent = 0.5,
                 kFeatureWidth = 0.082;

// Contrast sensitivity of a channel: a sum of Gaussians exp(-pi^2 x^2 / b), x in degrees, of weight
// a sqrt(pi / b).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[3] = {  // of lightness, red-green, blue-yellow
    {1, 0.0047, 0, 1e-5},
    {1, 0.0053, 0, 1e-5},
    {34.1, 0.04, 13.5, 0.025}};

struct Plane {
  int width = 0, height = 0;
  std::vector<double> v;
  double& at(int x, int y) { return v[size_t(y) * width + x]; }
  double at(int x, int y) const { return v[size_t(y) * width + x]; }
};

using Kernel = std::vector<double>;  // 2 r + 1 weights

// Columns by one kernel, rows by the other; pixels outside are those at the border.
Plane filtered(const Plane& in, const Kernel& across, const Kernel& down) {
  const int r = int(across.size()) / 2;
  Plane rows = in, out = in;
  parallel_for(in.height, [&](int y) {
    for (int x = 0; x < in.width; ++x) {
      double sum = 0;
      for (int k = -r; k <= r; ++k)
        sum += across[size_t(k + r)] * in.at(std::clamp(x + k, 0, in.width - 1), y);
      rows.at(x, y) = sum;
    }
  });
  parallel_for(in.height, [&](int y) {
    for (int x = 0; x < in.width; ++x) {
      double sum = 0;
      for (int k = -r; k <= r; ++k)
        sum += down[size_t(k + r)] * rows.at(x, std::clamp(y + k, 0, in.height - 1));
      out.at(x, y) = sum;
    }
  });
  return out;
}

double sum_of(const Kernel& k) {
  double sum = 0;
  for (const double v : k) sum += v;
  return sum;
}

// exp(-pi^2 x^2 / b) of pixels within three deviations of the widest of all channels.
Kernel sensitivity_kernel(double b, double pixels_per_degree) {
  const int r = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi64 * kPi64)) * pixels_per_degree));
  Kernel k;
  for (int i = -r; i <= r; ++i)
    k.push_back(std::exp(-kPi64 * kPi64 * std::pow(i / pixels_per_degree, 2) / b));
  return k;
}

// What the eye resolves of a channel.
Plane seen(const Plane& in, const Sensitivity& s, double pixels_per_degree) {
  const Kernel first = sensitivity_kernel(s.b1, pixels_per_degree),
               second = sensitivity_kernel(s.b2, pixels_per_degree);
  const double w1 = s.a1 * std::sqrt(kPi64 / s.b1), w2 = s.a2 * std::sqrt(kPi64 / s.b2);
  const double total = w1 * std::pow(sum_of(first), 2) + w2 * std::pow(sum_of(second), 2);
  Plane out = filtered(in, first, first);
  for (double& v : out.v) v *= w1 / total;
  if (w2 == 0) return out;
  const Plane rest = filtered(in, second, second);
  for (size_t i = 0; i < out.v.size(); ++i) out.v[i] += rest.v[i] * w2 / total;
  return out;
}

Vec3d xyz_from_linear(Vec3d c) { return {dot(kToXyz[0], c), dot(kToXyz[1], c), dot(kToXyz[2], c)}; }

// Opponent colors: lightness, red-green, blue-yellow, all linear in the radiance.
Vec3d opponent_from_linear(Vec3d c) {
  const Vec3d p = xyz_from_linear(c);
  const double x = p.x / kWhite.x, y = p.y / kWhite.y, z = p.z / kWhite.z;
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3d linear_from_opponent(Vec3d c) {
  const double y = (c.x + 16) / 116, x = y + c.y / 500, z = y - c.z / 200;
  static const Mat3d linear_from_xyz = inverse(Mat3d{{kToXyz[0], kToXyz[1], kToXyz[2]}});
  return linear_from_xyz * Vec3d{x * kWhite.x, y * kWhite.y, z * kWhite.z};
}

// CIE L*a*b* whose chroma is reduced in the dark, where it is seen less. [Hunt 1952]
Vec3d lab_from_linear(Vec3d c) {
  const auto curve = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Vec3d p = xyz_from_linear(c);
  const double x = curve(p.x / kWhite.x), y = curve(p.y / kWhite.y), z = curve(p.z / kWhite.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

// [Abasi et al. 2020]
double hyab(Vec3d a, Vec3d b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// Difference of two filtered colors, [0, 1].
double color_error(Vec3d a, Vec3d b) {
  static const double largest =
      std::pow(hyab(lab_from_linear({0, 1, 0}), lab_from_linear({0, 0, 1})), kColorExponent);
  const double e = std::pow(hyab(a, b), kColorExponent), bend = kBreak * largest;
  return e < bend ? kAtBreak / bend * e : kAtBreak + (e - bend) / (largest - bend) * (1 - kAtBreak);
}

struct Channels {
  Plane plane[3];
};

Channels opponent_channels(const Image& srgb) {
  Channels c;
  for (Plane& p : c.plane)
    p = {srgb.width, srgb.height, std::vector<double>(size_t(srgb.width) * srgb.height)};
  for (int y = 0; y < srgb.height; ++y)
    for (int x = 0; x < srgb.width; ++x) {
      const Vec3d o = opponent_from_linear(to_double(linear_from_srgb(srgb.rgb(x, y))));
      for (int k = 0; k < 3; ++k) c.plane[k].at(x, y) = o[k];
    }
  return c;
}

// L*a*b* of what the eye resolves.
std::vector<Vec3d> seen_colors(const Channels& c, double pixels_per_degree) {
  Plane p[3];
  for (int k = 0; k < 3; ++k) p[k] = seen(c.plane[k], kSensitivities[k], pixels_per_degree);
  std::vector<Vec3d> out(p[0].v.size());
  for (size_t i = 0; i < out.size(); ++i) {
    Vec3d rgb = linear_from_opponent({p[0].v[i], p[1].v[i], p[2].v[i]});
    for (int k = 0; k < 3; ++k) rgb[k] = std::clamp(rgb[k], 0.0, 1.0);
    out[i] = lab_from_linear(rgb);
  }
  return out;
}

struct FeatureKernels {
  Kernel smooth, edge, point;  // a Gaussian, its first and its second derivative
};

// Positive weights sum to 1, negative ones to -1.
Kernel balanced(Kernel k) {
  double positive = 0, negative = 0;
  for (const double v : k) (v > 0 ? positive : negative) += v;
  for (double& v : k) v /= v > 0 ? positive : -negative;
  return k;
}

FeatureKernels feature_kernels(double pixels_per_degree) {
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  const int r = int(std::ceil(3 * deviation));
  FeatureKernels k;
  for (int i = -r; i <= r; ++i) {
    const double u = i / deviation, g = std::exp(-0.5 * u * u);
    k.smooth.push_back(g);
    k.edge.push_back(-i * g);
    k.point.push_back((u * u - 1) * g);
  }
  const double sum = sum_of(k.smooth);
  for (double& v : k.smooth) v /= sum;
  k.edge = balanced(k.edge);
  k.point = balanced(k.point);
  return k;
}

// Strength of edges or points at each pixel.
std::vector<double> strength(const Plane& lightness, const Kernel& smooth, const Kernel& derivative) {
  const Plane across = filtered(lightness, derivative, smooth),
              down = filtered(lightness, smooth, derivative);
  std::vector<double> out(across.v.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(across.v[i], down.v[i]);
  return out;
}

struct Features {
  std::vector<double> edges, points;
};

Features features_of(const Channels& c, const FeatureKernels& k) {
  Plane lightness = c.plane[0];
  for (double& v : lightness.v) v = (v + 16) / 116;
  return {strength(lightness, k.smooth, k.edge), strength(lightness, k.smooth, k.point)};
}

double feature_error(const Features& a, const Features& b, size_t i) {
  const double d = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
  return std::min(std::pow(d / std::numbers::sqrt2, kFeatureExponent), 1.0);
}

}  // namespace

Image flip_map(const Image& reference, const Image& test, double pixels_per_degree) {
  if (reference.width != test.width || reference.height != test.height || reference.channels != 3 ||
      test.channels != 3 || reference.empty())
    fail("FLIP needs two RGB images of one size; got {} x {} x {} and {} x {} x {}.", reference.width,
         reference.height, reference.channels, test.width, test.height, test.channels);
  const Channels a = opponent_channels(reference), b = opponent_channels(test);
  const FeatureKernels kernels = feature_kernels(pixels_per_degree);
  const Features features_a = features_of(a, kernels), features_b = features_of(b, kernels);
  const std::vector<Vec3d> colors_a = seen_colors(a, pixels_per_degree),
                           colors_b = seen_colors(b, pixels_per_degree);
  Image map(reference.width, reference.height, 1);
  for (size_t i = 0; i < map.data.size(); ++i)
    map.data[i] =
        float(std::pow(color_error(colors_a[i], colors_b[i]), 1 - feature_error(features_a, features_b, i)));
  return map;
}

double flip(const Image& reference, const Image& test) {
  return *flip_in_area(reference, test, Area(size_t(reference.width) * reference.height, 1));
}

std::optional<double> flip_in_area(const Image& reference, const Image& test, const Area& area) {
  const Image map = flip_map(reference, test);
  if (area.size() != map.data.size())
    fail("An area of {} pixels does not fit an image of {} x {}.", area.size(), map.width, map.height);
  double sum = 0;
  size_t pixels = 0;
  for (size_t i = 0; i < area.size(); ++i)
    if (area[i]) sum += double(map.data[i]), ++pixels;
  if (pixels == 0) return std::nullopt;
  return sum / double(pixels);
}

}  // namespace cei3d

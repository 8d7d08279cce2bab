// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/lobe_blur.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/math/reflection.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kCellSamples = 3;  // along an axis: a narrow lobe is thinner than a cell

// Mean of the lobe around r over the cell at (column, row), times its solid angle.
float lobe_in_cell(Vec3f r, int column, int row, int height, const ReflectionLobe<float>& lobe) {
  float sum = 0;
  for (int a = 0; a < kCellSamples; ++a)
    for (int b = 0; b < kCellSamples; ++b) {
      const float u = float(column) + (float(a) + 0.5f) / kCellSamples,
                  v = float(row) + (float(b) + 0.5f) / kCellSamples;
      const float c = dot(r, env_direction(u, v, 2 * height, height));
      for (int j = 0; j < kReflectionLobes; ++j) sum += lobe.weight[j] * std::exp(lobe.lambda[j] * (c - 1));
    }
  return sum * env_solid_angle(row, 2 * height, height);
}

// [row out][row in][column difference]: rows of the matrix sum to 1.
std::vector<float> lobe_kernel(float roughness, int height) {
  const int width = 2 * height;
  const ReflectionLobe<float> lobe = reflection_lobe(roughness);
  std::vector<float> kernel(size_t(height) * height * width);
  parallel_for(height, [&](int out) {
    float* entries = &kernel[size_t(out) * height * width];
    const Vec3f r = env_direction(0.5f, float(out) + 0.5f, width, height);
    double total = 0;
    for (int in = 0; in < height; ++in)
      for (int k = 0; k < width; ++k)
        total += entries[size_t(in) * width + k] = lobe_in_cell(r, k, in, height, lobe);
    for (int i = 0; i < height * width; ++i) entries[i] = float(entries[i] / total);
  });
  return kernel;
}

}  // namespace

LobeBlur::LobeBlur(float roughness, int height)
    : height_(height), width_(2 * height), frequencies_(height + 1) {
  for (int a = 0; a < width_; ++a)
    for (int b = 0; b < width_; ++b) {
      const double angle = 2 * M_PI * (a * b % width_) / width_;
      cosines_.push_back(float(std::cos(angle)));
      sines_.push_back(float(std::sin(angle)));
    }
  std::vector<float> kernel = lobe_kernel(roughness, height);
  spectrum_ = spectrum_of(kernel);
  for (float& k : kernel) k *= k;
  squared_spectrum_ = spectrum_of(kernel);
}

std::vector<float> LobeBlur::spectrum_of(const std::vector<float>& kernel) const {
  std::vector<float> spectrum(size_t(height_) * height_ * frequencies_, 0.0f);
  parallel_for(height_ * height_, [&](int i) {
    const float* row = &kernel[size_t(i) * width_];
    for (int f = 0; f < frequencies_; ++f) {
      double sum = 0;
      for (int k = 0; k < width_; ++k) sum += double(row[k]) * cosines_[size_t(f) * width_ + k];
      spectrum[size_t(i) * frequencies_ + f] = float(sum);
    }
  });
  return spectrum;
}

// The inner loops run over neighboring floats, so that compilers vectorize them.
LobeBlur::RowSpectrum LobeBlur::transformed(std::span<const Vec3f> row) const {
  const int n = frequencies_;
  RowSpectrum out(6 * size_t(n), 0.0f);
  for (int k = 0; k < width_; ++k) {
    const float *cosine = &cosines_[size_t(k) * width_], *sine = &sines_[size_t(k) * width_];
    for (int c = 0; c < 3; ++c) {
      const float value = row[size_t(k)][c];
      float *re = &out[size_t(2 * c) * n], *im = re + n;
      for (int f = 0; f < n; ++f) {
        re[f] += value * cosine[f];
        im[f] -= value * sine[f];
      }
    }
  }
  return out;
}

void LobeBlur::transform_back(const RowSpectrum& spectrum, std::span<Vec3f> row) const {
  const int n = frequencies_;
  std::vector<float> line(static_cast<size_t>(width_));
  for (int c = 0; c < 3; ++c) {
    const float *re = &spectrum[size_t(2 * c) * n], *im = re + n, *last = &cosines_[size_t(n - 1) * width_];
    for (int d = 0; d < width_; ++d) line[size_t(d)] = re[0] + re[n - 1] * last[d];
    for (int f = 1; f < n - 1; ++f) {
      const float *cosine = &cosines_[size_t(f) * width_], *sine = &sines_[size_t(f) * width_];
      for (int d = 0; d < width_; ++d) line[size_t(d)] += 2 * (re[f] * cosine[d] - im[f] * sine[d]);
    }
    for (int d = 0; d < width_; ++d) row[size_t(d)][c] = line[size_t(d)] / float(width_);
  }
}

void LobeBlur::run(const std::vector<float>& spectrum, bool transposed, const std::vector<Vec3f>& in,
                   std::vector<Vec3f>& out) const {
  const int n = frequencies_;
  std::vector<RowSpectrum> rows(static_cast<size_t>(height_));
  parallel_for(height_, [&](int j) {
    rows[size_t(j)] = transformed(std::span(in).subspan(size_t(j) * width_, size_t(width_)));
  });
  out.resize(in.size());
  parallel_for(height_, [&](int i) {
    RowSpectrum sum(6 * size_t(n), 0.0f);
    for (int j = 0; j < height_; ++j) {
      const float* k = &spectrum[(transposed ? size_t(j) * height_ + i : size_t(i) * height_ + j) * n];
      for (int part = 0; part < 6; ++part)
        for (int f = 0; f < n; ++f) sum[size_t(part) * n + f] += k[f] * rows[size_t(j)][size_t(part) * n + f];
    }
    transform_back(sum, std::span(out).subspan(size_t(i) * width_, size_t(width_)));
  });
}

void LobeBlur::apply(const std::vector<Vec3f>& light, std::vector<Vec3f>& blurred) const {
  run(spectrum_, false, light, blurred);
}
void LobeBlur::apply_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const {
  run(spectrum_, true, blurred, light);
}
void LobeBlur::apply_squared_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const {
  run(squared_spectrum_, true, blurred, light);
}

}  // namespace cei3d

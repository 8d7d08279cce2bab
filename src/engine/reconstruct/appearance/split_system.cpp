// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_system.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr int kChunks = 16;        // of rows; fixed, so that sums are the same on any machine
constexpr float kSpecular = 0.5f;  // of a dielectric: reflections show the product of light and reflectance
constexpr float kGrazing = 0.1f;   // samples seen flatter than this are left out: silhouettes and bad normals
constexpr float kDarkest = 0.003f;  // radiance below which the display curve's slope is not followed further

Vec3f interpolate(const std::vector<Vec3f>& values, const std::array<uint32_t, 3>& v,
                  const std::array<float, 3>& b) {
  return values[v[0]] * b[0] + values[v[1]] * b[1] + values[v[2]] * b[2];
}

void set_far_hit(const Mesh& mesh, const Surface::RayHit& h, SplitRow& row) {
  const auto& t = mesh.triangles[h.triangle];
  row.blocked = true;
  row.far_vertices = {t[0], t[1], t[2]};
  row.far_barycentric = {1 - h.b1 - h.b2, h.b1, h.b2};
}

std::vector<uint32_t> choose_samples(const SurfaceSamples& s, const LinearSplitOptions& o) {
  std::vector<uint32_t> kept;
  const double share = double(o.most_hits) / std::max<double>(1, double(s.hits.size()));
  for (uint32_t i = 0; i < s.hits.size(); ++i)
    if (dot(s.hits[i].normal, s.hits[i].to_camera) > kGrazing && Rng(o.seed, 0, i).uniform() < share)
      kept.push_back(i);
  return kept;
}

}  // namespace

std::vector<SplitRow> make_split_rows(const Surface& surface, const SurfaceSamples& samples,
                                      const LinearSplitOptions& options) {
  const Mesh& mesh = surface.mesh();
  const std::vector<uint32_t> kept = choose_samples(samples, options);
  const size_t n = kept.size();
  std::vector<SplitRow> rows(n);
  std::vector<Vec3f> origins(n), directions(n);
  for (size_t k = 0; k < n; ++k) {
    const Hit& h = samples.hits[kept[k]];
    SplitRow& row = rows[k];
    const auto& t = mesh.triangles[h.triangle];
    row = {};
    row.vertices = {t[0], t[1], t[2]};
    row.barycentric = {1 - h.b1 - h.b2, h.b1, h.b2};
    row.nv = dot(h.normal, h.to_camera);
    row.color = samples.colors[kept[k]];
    for (int c = 0; c < 3; ++c) row.weight[c] = square(srgb_slope(max(row.color[c], kDarkest)));
    row.clipped = samples.clipped.empty() ? 0 : samples.clipped[kept[k]];
    origins[k] = ray_origin(h);
    directions[k] = mirror_direction(h);
  }
  std::vector<Surface::RayHit> hits(n);
  surface.intersect(origins, directions, 0, hits);
  for (size_t k = 0; k < n; ++k) {
    rows[k].taps = env_taps(directions[k], 2 * options.light_height, options.light_height);
    if (hits[k].t >= 0) set_far_hit(mesh, hits[k], rows[k]);
  }
  return rows;
}

LobeBlur::LobeBlur(float roughness, int height) : height_(height), width_(2 * height) {
  kernel_.assign(size_t(height_) * height_ * width_, 0);
  const float alpha = roughness * roughness;
  parallel_for(height_, [&](int out) {
    float* rows = &kernel_[size_t(out) * height_ * width_];
    double total = 0;
    const Vec3f r = env_direction(0.5f, float(out) + 0.5f, width_, height_);
    for (int in = 0; in < height_; ++in)
      for (int k = 0; k < width_; ++k) {
        // Mean over the cell: a narrow lobe is thinner than a cell.
        float sum = 0;
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const float u = float(k) + (float(a) + 0.5f) / 3, v = float(in) + (float(b) + 0.5f) / 3;
            const float c = dot(r, env_direction(u, v, width_, height_));
            if (c > 0) sum += smith_g1(c, alpha) * ggx_density(sqrt(0.5f * (1 + c)), alpha);
          }
        const float w = sum * env_solid_angle(in, width_, height_);
        rows[size_t(in) * width_ + k] = w;
        total += w;
      }
    for (int i = 0; i < height_ * width_; ++i) rows[i] = float(rows[i] / total);
  });
}

void LobeBlur::run(const std::vector<float>& kernel, bool transposed, const std::vector<Vec3f>& in,
                   std::vector<Vec3f>& out) const {
  out.assign(in.size(), {0, 0, 0});
  parallel_for(height_, [&](int i) {
    std::vector<float> sum(3 * size_t(width_), 0), k2(2 * size_t(width_));
    for (int j = 0; j < height_; ++j) {
      const float* k = &kernel[(transposed ? size_t(j) * height_ + i : size_t(i) * height_ + j) * width_];
      for (int d = 0; d < width_; ++d)
        k2[d] = k2[d + width_] = k[d];  // symmetric in d, so transposing is free
      for (int s = 0; s < width_; ++s) {
        const Vec3f v = in[size_t(j) * width_ + s];
        const float* shifted = &k2[width_ - s];
        for (int c = 0; c < 3; ++c) {
          float* row = &sum[size_t(c) * width_];
          const float x = v[c];
          for (int d = 0; d < width_; ++d) row[d] += x * shifted[d];
        }
      }
    }
    for (int d = 0; d < width_; ++d)
      out[size_t(i) * width_ + d] = {sum[d], sum[width_ + d], sum[2 * width_ + d]};
  });
}
void LobeBlur::apply(const std::vector<Vec3f>& light, std::vector<Vec3f>& blurred) const {
  run(kernel_, false, light, blurred);
}
void LobeBlur::apply_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const {
  run(kernel_, true, blurred, light);
}
void LobeBlur::apply_squared_transposed(const std::vector<Vec3f>& blurred, std::vector<Vec3f>& light) const {
  std::vector<float> squared(kernel_);
  for (float& k : squared) k *= k;
  run(squared, true, blurred, light);
}

SplitSystem::SplitSystem(const Mesh& mesh, const std::vector<SplitRow>& rows,
                         const LinearSplitOptions& options)
    : mesh_(mesh), rows_(rows), options_(options) {
  for (const SplitRow& row : rows) weights_.push_back(row.weight);
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c)
      if (t[c] < t[(c + 1) % 3]) edges_.push_back({t[c], t[(c + 1) % 3]});
}

void SplitSystem::set_roughness(float roughness) {
  roughness_ = roughness;
  blur_ = std::make_unique<LobeBlur>(roughness, options_.light_height);
  split_sum_.resize(rows_.size());
  diffuse_view_.resize(rows_.size());
  const float* table = split_sum_table();
  parallel_ranges(int(rows_.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      split_sum_[i] = split_sum(table, rows_[i].nv, roughness);
      diffuse_view_[i] = diffuse_view(clamp(rows_[i].nv, 0.0f, 1.0f), roughness);
    }
  });
}

void SplitSystem::set_metal(std::vector<Vec3f> color) { metal_ = std::move(color); }

Vec3f SplitSystem::gain(size_t i) const {
  const SplitRow& row = rows_[i];
  const Vec3f black{0, 0, 0};
  const Vec3f f0 = metal_.empty()
                       ? f0_of(black, kSpecular, 0.0f)
                       : f0_of(interpolate(metal_, row.vertices, row.barycentric), kSpecular, 1.0f);
  return reflectance(split_sum_[i], f0);
}

Vec3f SplitSystem::predict(size_t i, const SplitUnknowns& x, const std::vector<Vec3f>& blurred) const {
  const SplitRow& row = rows_[i];
  Vec3f seen{0, 0, 0};
  if (row.blocked)
    seen = interpolate(x.diffuse, row.far_vertices, row.far_barycentric);
  else
    for (int k = 0; k < 4; ++k) seen += blurred[row.taps.pixel[k]] * row.taps.weight[k];
  return interpolate(x.diffuse, row.vertices, row.barycentric) * diffuse_view_[i] + gain(i) * seen;
}

void SplitSystem::release_bounds(const SplitUnknowns& x) {
  std::vector<Vec3f> blurred;
  blur_->apply(x.light, blurred);
  parallel_ranges(int(rows_.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const SplitRow& row = rows_[i];
      if (!row.clipped) continue;
      const Vec3f above = predict(size_t(i), x, blurred) - row.color;
      for (int c = 0; c < 3; ++c) weights_[i][c] = (row.clipped >> c & 1) && above[c] > 0 ? 0 : row.weight[c];
    }
  });
}

template <class F>
void SplitSystem::accumulate(F row_value, SplitUnknowns& out) const {
  const size_t cells = size_t(2) * options_.light_height * options_.light_height;
  std::vector<SplitUnknowns> part(kChunks);
  const bool dielectric = metal_.empty();
  parallel_for(kChunks, [&](int chunk) {
    SplitUnknowns& sum = part[chunk];
    sum.diffuse.assign(dielectric ? mesh_.positions.size() : 0, {0, 0, 0});
    sum.light.assign(cells, {0, 0, 0});
    const size_t begin = rows_.size() * chunk / kChunks, end = rows_.size() * (chunk + 1) / kChunks;
    for (size_t i = begin; i < end; ++i) {
      const SplitRow& row = rows_[i];
      if (!dielectric && row.blocked) continue;
      const Vec3f y = row_value(i) * weights_[i], g = y * gain(i);
      if (dielectric)
        for (int k = 0; k < 3; ++k)
          sum.diffuse[row.vertices[k]] += y * (row.barycentric[k] * diffuse_view_[i]);
      if (row.blocked)
        for (int k = 0; k < 3; ++k) sum.diffuse[row.far_vertices[k]] += g * row.far_barycentric[k];
      else
        for (int k = 0; k < 4; ++k) sum.light[row.taps.pixel[k]] += g * row.taps.weight[k];
    }
  });
  out.diffuse.assign(mesh_.positions.size(), {0, 0, 0});
  std::vector<Vec3f> blurred(cells, Vec3f{0, 0, 0});
  if (dielectric)
    parallel_ranges(int(out.diffuse.size()), 4096, [&](int begin, int end) {
      for (int chunk = 0; chunk < kChunks; ++chunk)
        for (int v = begin; v < end; ++v) out.diffuse[v] += part[chunk].diffuse[v];
    });
  for (const SplitUnknowns& p : part)
    for (size_t i = 0; i < cells; ++i) blurred[i] += p.light[i];
  blur_->apply_transposed(blurred, out.light);
}

void SplitSystem::smooth(const SplitUnknowns& x, SplitUnknowns& out) const {
  const int h = options_.light_height, w = 2 * h;
  const auto link = [&](int a, int b) {
    const Vec3f d = (x.light[a] - x.light[b]) * light_smoothness_;
    out.light[a] += d;
    out.light[b] += -d;
  };
  for (int i = 0; i < h; ++i)
    for (int j = 0; j < w; ++j) {
      link(i * w + j, i * w + (j + 1) % w);
      if (i + 1 < h) link(i * w + j, (i + 1) * w + j);
    }
  if (!metal_.empty()) return;
  for (const auto& e : edges_) {
    const Vec3f d = (x.diffuse[e[0]] - x.diffuse[e[1]]) * diffuse_smoothness_;
    out.diffuse[e[0]] += d;
    out.diffuse[e[1]] += -d;
  }
}

void SplitSystem::normal(const SplitUnknowns& x, SplitUnknowns& out) const {
  std::vector<Vec3f> blurred;
  blur_->apply(x.light, blurred);
  accumulate([&](size_t row) { return predict(row, x, blurred); }, out);
  smooth(x, out);
}

void SplitSystem::right_side(SplitUnknowns& out) const {
  accumulate([&](size_t row) { return rows_[row].color; }, out);
}

double SplitSystem::residual(const SplitUnknowns& x) const {
  std::vector<Vec3f> blurred;
  blur_->apply(x.light, blurred);
  std::vector<double> sum(kChunks, 0), count(kChunks, 0);  // of rows and channels
  parallel_for(kChunks, [&](int chunk) {
    const size_t begin = rows_.size() * chunk / kChunks, end = rows_.size() * (chunk + 1) / kChunks;
    for (size_t i = begin; i < end; ++i) {
      const SplitRow& row = rows_[i];
      if (row.blocked) continue;
      const Vec3f e = predict(i, x, blurred) - row.color;
      count[chunk] += 3;
      for (int c = 0; c < 3; ++c) {
        if ((row.clipped >> c & 1) && e[c] > 0) continue;
        sum[chunk] += double(row.weight[c]) * e[c] * e[c];
      }
    }
  });
  double total = 0, n = 0;
  for (int c = 0; c < kChunks; ++c) total += sum[c], n += count[c];
  return total / std::max(n, 1.0);
}

SplitUnknowns SplitSystem::diagonal() const {
  const size_t cells = size_t(2) * options_.light_height * options_.light_height;
  SplitUnknowns d;
  d.diffuse.assign(mesh_.positions.size(), {0, 0, 0});
  std::vector<Vec3f> mass(cells, Vec3f{0, 0, 0});
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SplitRow& row = rows_[i];
    if (!metal_.empty() && row.blocked) continue;
    const Vec3f g = gain(i), gg = row.weight * g * g;
    for (int k = 0; k < 3; ++k)
      d.diffuse[row.vertices[k]] += row.weight * square(row.barycentric[k] * diffuse_view_[i]);
    if (row.blocked)
      for (int k = 0; k < 3; ++k) d.diffuse[row.far_vertices[k]] += gg * square(row.far_barycentric[k]);
    else
      for (int k = 0; k < 4; ++k) mass[row.taps.pixel[k]] += gg * row.taps.weight[k];
  }
  blur_->apply_squared_transposed(mass, d.light);
  return d;
}

namespace {

struct Sums {
  double v[3] = {0, 0, 0};
};

Sums dot_product(const SplitUnknowns& a, const SplitUnknowns& b) {
  Sums s;
  for (const auto& [x, y] : {std::pair{&a.diffuse, &b.diffuse}, std::pair{&a.light, &b.light}})
    for (size_t i = 0; i < x->size(); ++i)
      for (int c = 0; c < 3; ++c) s.v[c] += double((*x)[i][c]) * (*y)[i][c];
  return s;
}

Vec3f ratio(const Sums& a, const Sums& b) {
  Vec3f r;
  for (int c = 0; c < 3; ++c) r[c] = b.v[c] > 1e-30 ? float(a.v[c] / b.v[c]) : 0.0f;
  return r;
}

template <class F>
void for_both(SplitUnknowns& a, const SplitUnknowns& b, F f) {
  for (size_t i = 0; i < a.diffuse.size(); ++i) f(a.diffuse[i], b.diffuse[i]);
  for (size_t i = 0; i < a.light.size(); ++i) f(a.light[i], b.light[i]);
}

void mask(SplitUnknowns& x, const std::vector<std::array<uint8_t, 3>>& frozen, bool metal) {
  for (size_t i = 0; i < frozen.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (frozen[i][c]) x.light[i][c] = 0;
  if (metal)
    for (Vec3f& d : x.diffuse) d = {0, 0, 0};
}

}  // namespace

void SplitSystem::descend(SplitUnknowns& x, const SplitUnknowns& inverse, int steps) const {
  const bool metal = !metal_.empty();
  SplitUnknowns r, ax;
  right_side(r);
  normal(x, ax);
  for_both(r, ax, [](Vec3f& a, const Vec3f& b) { a = a - b; });
  // Light that stands at zero and would still sink stays out of this round.
  std::vector<std::array<uint8_t, 3>> frozen(x.light.size(), std::array<uint8_t, 3>{0, 0, 0});
  for (size_t i = 0; i < frozen.size(); ++i)
    for (int c = 0; c < 3; ++c) frozen[i][c] = x.light[i][c] <= 0 && r.light[i][c] < 0;
  mask(r, frozen, metal);
  SplitUnknowns z = r;
  for_both(z, inverse, [](Vec3f& a, const Vec3f& b) { a = a * b; });
  SplitUnknowns p = z;
  Sums rz = dot_product(r, z);
  for (int k = 0; k < steps; ++k) {
    normal(p, ax);
    mask(ax, frozen, metal);
    const Vec3f alpha = ratio(rz, dot_product(p, ax));
    for_both(x, p, [&](Vec3f& a, const Vec3f& b) { a += alpha * b; });
    for_both(r, ax, [&](Vec3f& a, const Vec3f& b) { a = a - alpha * b; });
    z = r;
    for_both(z, inverse, [](Vec3f& a, const Vec3f& b) { a = a * b; });
    const Sums next = dot_product(r, z);
    const Vec3f beta = ratio(next, rz);
    rz = next;
    for_both(p, z, [&](Vec3f& a, const Vec3f& b) { a = b + beta * a; });
  }
}

void SplitSystem::solve(SplitUnknowns& x, int rounds, int steps) {
  SplitUnknowns inverse = diagonal();
  Vec3f mean_light{0, 0, 0}, mean_diffuse{0, 0, 0};
  for (const Vec3f& d : inverse.light) mean_light += d / float(inverse.light.size());
  for (const Vec3f& d : inverse.diffuse) mean_diffuse += d / float(inverse.diffuse.size());
  light_smoothness_ = options_.smoothness * (mean_light.x + mean_light.y + mean_light.z) / 3;
  diffuse_smoothness_ = 1e-3f * (mean_diffuse.x + mean_diffuse.y + mean_diffuse.z) / 3;
  for (Vec3f& d : inverse.light)
    for (int c = 0; c < 3; ++c) d[c] = 1 / (d[c] + 4 * light_smoothness_ + 1e-3f * mean_light[c] + 1e-20f);
  for (Vec3f& d : inverse.diffuse)
    for (int c = 0; c < 3; ++c) d[c] = 1 / (d[c] + 6 * diffuse_smoothness_ + 1e-20f);
  for (int round = 0; round < rounds; ++round) {
    release_bounds(x);
    descend(x, inverse, steps);
    for (Vec3f& l : x.light)
      for (int c = 0; c < 3; ++c) l[c] = max(l[c], 0.0f);
  }
}

std::vector<Vec3f> SplitSystem::fit_metal_color(const SplitUnknowns& x) const {
  std::vector<Vec3f> blurred;
  blur_->apply(x.light, blurred);
  const size_t n = mesh_.positions.size();
  std::vector<Vec3f> above(n, Vec3f{0, 0, 0}), below(n, Vec3f{0, 0, 0});
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SplitRow& row = rows_[i];
    if (row.blocked) continue;
    Vec3f seen{0, 0, 0};
    for (int k = 0; k < 4; ++k) seen += blurred[row.taps.pixel[k]] * row.taps.weight[k];
    const Vec3f slope = seen * split_sum_[i].scale, rest = row.color - seen * split_sum_[i].bias;
    for (int k = 0; k < 3; ++k) {
      above[row.vertices[k]] += weights_[i] * slope * rest * row.barycentric[k];
      below[row.vertices[k]] += weights_[i] * slope * slope * row.barycentric[k];
    }
  }
  // Unseen vertices, and to a small part all, take the mean color.
  Vec3f a{0, 0, 0}, b{0, 0, 0};
  for (size_t v = 0; v < n; ++v) a += above[v], b += below[v];
  const Vec3f mean = a / (b + Vec3f{1e-20f, 1e-20f, 1e-20f}),
              prior = b * (0.01f / float(n)) + Vec3f{1e-20f, 1e-20f, 1e-20f};
  for (size_t v = 0; v < n; ++v)
    for (int c = 0; c < 3; ++c)
      above[v][c] = clamp((above[v][c] + prior[c] * mean[c]) / (below[v][c] + prior[c]), 0.0f, 4.0f);
  return above;
}

}  // namespace cei3d

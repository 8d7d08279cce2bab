// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/split_system.h"

#include <algorithm>
#include <span>

#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "engine/reconstruct/appearance/split_irradiance.h"

namespace cei3d {
namespace {

constexpr size_t kChunks = 16;

}  // namespace

double SplitMaterials::metal_share() const {
  const auto metals =
      std::count_if(of.begin(), of.end(), [](const Material& m) { return m.metalness > 0.5f; });
  return double(metals) / double(std::max<size_t>(of.size(), 1));
}

SplitSystem::SplitSystem(const Mesh& mesh, const std::vector<SplitRow>& rows,
                         const LinearSplitOptions& options)
    : mesh_(mesh),
      rows_(rows),
      chunks_(chunks_of_rows()),
      options_(options),
      edges_(edges_of(mesh.triangles)),
      blurs_(options.light_height),
      harmonics_(options.light_height) {
  for (const SplitRow& row : rows) weights_.push_back(row.held_out ? Vec3f{0, 0, 0} : row.weight);
  for (const SplitRow& row : rows) views_ = std::max(views_, row.view + 1);
}

std::vector<SplitSystem::Chunk> SplitSystem::chunks_of_rows() const {
  std::vector<Chunk> out;
  for (size_t i = 0; i < kChunks; ++i) {
    Chunk chunk{rows_.size() * i / kChunks, rows_.size() * (i + 1) / kChunks, 0, 0};
    if (chunk.begin < chunk.end) chunk.first_vertex = rows_[chunk.begin].vertices[0];
    for (size_t row = chunk.begin; row < chunk.end; ++row)
      for (const uint32_t v : rows_[row].vertices) {
        chunk.first_vertex = std::min(chunk.first_vertex, v);
        chunk.vertices_end = std::max(chunk.vertices_end, v + 1);
      }
    out.push_back(chunk);
  }
  return out;
}

SplitSystem::Optics SplitSystem::optics_of(const SplitRow& row) const {
  const auto& v = row.vertices;
  const auto& b = row.barycentric;
  float roughness = 0, f90 = 0;
  Vec3f f0{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const Material& m = materials_.of[v[k]];
    roughness += m.roughness * b[k];
    f0 += f0_of(materials_.color[v[k]], m.specular, m.metalness) * b[k];
    f90 += f90_of(m.specular, m.metalness) * b[k];
  }
  Optics o;
  o.base = reflected_sky(row, ReflectionPart::base, roughness, options_.light_height);
  o.fresnel = reflected_sky(row, ReflectionPart::fresnel, roughness, options_.light_height);
  o.split_sum = split_sum(split_sum_table(), row.nv, roughness);
  o.gains = reflection_gains(o.split_sum, f0, f90);
  o.far_gain = o.gain_of(1 - o.base.open, 1 - o.fresnel.open);
  o.diffuse_view = diffuse_view_of(row, roughness, light_directions_);
  return o;
}

void SplitSystem::set_light(const std::vector<Vec3f>& light) {
  light_directions_ = light_directions(sky_radiance(light_image(light, options_.light_height)));
}

void SplitSystem::set_materials(SplitMaterials materials) {
  materials_ = std::move(materials);
  optics_.resize(rows_.size());
  parallel_ranges(int(rows_.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) optics_[i] = optics_of(rows_[i]);
  });
  in_use_.fill(false);
  for (const Optics& o : optics_)
    for (const ReflectedSky* sky : {&o.base, &o.fresnel})
      in_use_[size_t(sky->lobe.level)] = in_use_[size_t(sky->lobe.level) + 1] = true;
}

SplitSystem::Sky SplitSystem::sky_of(const std::vector<Vec3f>& light) const {
  Sky out;
  for (int level = 0; level < BlurLadder::kLevels; ++level)
    if (in_use_[size_t(level)]) out.blurred.set(level, light, blurs_);
  if (!diffuse_light_grad_.rows.empty()) out.harmonics = harmonics_.of(light);
  return out;
}

SplitSystem::Sky SplitSystem::sky_change(const std::vector<Vec3f>& light) const {
  Sky sky = sky_of(light);
  for (size_t j = 0; j < kHarmonics; ++j) sky.harmonics[j] += -diffuse_light_grad_.light[j];
  return sky;
}

Vec3f SplitSystem::predict(size_t i, const SplitUnknowns& x, const Sky& sky) const {
  const SplitRow& row = rows_[i];
  const Optics& o = optics_[i];
  Vec3f diffuse = at_corners(x.diffuse, row.vertices, row.barycentric) * row.diffuse_light;
  if (!diffuse_light_grad_.rows.empty())
    diffuse += diffuse_light_grad_.rows[i].gain * dot(diffuse_light_grad_.rows[i].d_light, sky.harmonics);
  diffuse = diffuse * o.diffuse_view;
  return o.gains.added_to(diffuse, radiance_at(sky.blurred, o.base), radiance_at(sky.blurred, o.fresnel));
}

void SplitSystem::release_bounds(const SplitUnknowns& x) {
  const Sky sky = sky_change(x.light);
  parallel_ranges(int(rows_.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const SplitRow& row = rows_[i];
      if (!row.clipped || row.held_out) continue;
      const Vec3f above = predict(size_t(i), x, sky) + far_reflected(size_t(i)) - row.color;
      for (int c = 0; c < 3; ++c) weights_[i][c] = (row.clipped >> c & 1) && above[c] > 0 ? 0 : row.weight[c];
    }
  });
}

std::vector<Vec3f> SplitSystem::targets(const SplitUnknowns& x) const {
  const Sky sky = sky_change(x.light);
  std::vector<Vec3f> out(rows_.size());
  parallel_ranges(int(rows_.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      out[i] = rows_[i].color;
      if (!rows_[i].clipped) continue;
      const Vec3f seen = predict(size_t(i), x, sky) + far_reflected(size_t(i));
      for (int c = 0; c < 3; ++c)
        if (rows_[i].clipped >> c & 1) out[i][c] = max(out[i][c], seen[c]);
    }
  });
  return out;
}

// Sums of one chunk of rows.
struct SplitSystem::RowSums {
  uint32_t first_vertex;
  std::vector<Vec3f> diffuse;  // from first_vertex on
  Blurred sky;
  HarmonicLight harmonics{};
};

// Adds the contribution of a row to A^T y.
void SplitSystem::add_row(size_t i, Vec3f y, RowSums& sum) const {
  const SplitRow& row = rows_[i];
  const Optics& o = optics_[i];
  const Vec3f here = y * row.diffuse_light * o.diffuse_view;
  for (int k = 0; k < 3; ++k) sum.diffuse[row.vertices[k] - sum.first_vertex] += here * row.barycentric[k];
  if (!diffuse_light_grad_.rows.empty()) {
    const Vec3f weight = y * diffuse_light_grad_.rows[i].gain * o.diffuse_view;
    for (size_t j = 0; j < kHarmonics; ++j)
      sum.harmonics[j] += weight * diffuse_light_grad_.rows[i].d_light[j];
  }
  scatter_radiance(o.base, y * o.gains.base, sum.sky);
  scatter_radiance(o.fresnel, y * o.gains.fresnel, sum.sky);
}

// The light that the blurs and harmonics of all chunks stand for.
void SplitSystem::gather_light(const std::vector<RowSums>& parts, std::vector<Vec3f>& out) const {
  out.assign(cells(), {0, 0, 0});
  for (int level = 0; level < BlurLadder::kLevels; ++level) {
    if (!in_use_[size_t(level)]) continue;
    std::vector<Vec3f> sum(cells(), Vec3f{0, 0, 0}), light;
    for (const RowSums& part : parts) part.sky.add_to(level, sum);
    blurs_.level(level).apply_transposed(sum, light);
    for (size_t i = 0; i < cells(); ++i) out[i] += light[i];
  }
  for (const RowSums& part : parts)
    if (!diffuse_light_grad_.rows.empty()) harmonics_.add_transposed(part.harmonics, out);
}

template <class F>
void SplitSystem::accumulate(F row_value, SplitUnknowns& out) const {
  std::vector<RowSums> parts(chunks_.size());
  parallel_for(int(chunks_.size()), [&](int i) {
    const Chunk& chunk = chunks_[size_t(i)];
    RowSums& sum = parts[size_t(i)];
    sum.first_vertex = chunk.first_vertex;
    sum.diffuse.assign(chunk.vertices_end - chunk.first_vertex, {0, 0, 0});
    for (int level = 0; level < BlurLadder::kLevels; ++level)
      if (in_use_[size_t(level)]) sum.sky.clear(level, cells());
    for (size_t row = chunk.begin; row < chunk.end; ++row) add_row(row, row_value(row) * weights_[row], sum);
  });
  out.diffuse.assign(mesh_.positions.size(), {0, 0, 0});
  for (const RowSums& part : parts)
    for (size_t i = 0; i < part.diffuse.size(); ++i)
      if (const uint32_t v = part.first_vertex + uint32_t(i); !materials_.is_metal(v))
        out.diffuse[v] += part.diffuse[i];
  gather_light(parts, out.light);
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
  for (const auto& e : edges_) {
    if (materials_.is_metal(e[0]) || materials_.is_metal(e[1])) continue;
    const Vec3f d = (x.diffuse[e[0]] - x.diffuse[e[1]]) * diffuse_smoothness_;
    out.diffuse[e[0]] += d;
    out.diffuse[e[1]] += -d;
  }
}

void SplitSystem::normal(const SplitUnknowns& x, SplitUnknowns& out) const {
  const Sky sky = sky_of(x.light);
  accumulate([&](size_t row) { return predict(row, x, sky); }, out);
  smooth(x, out);
}

void SplitSystem::right_side(SplitUnknowns& out) const {
  // Minus the constant term of the linearization.
  const auto constant = [&](size_t row) {
    if (diffuse_light_grad_.rows.empty()) return Vec3f{0, 0, 0};
    const DiffuseLightGrad::OfRow& s = diffuse_light_grad_.rows[row];
    return s.gain * dot(s.d_light, diffuse_light_grad_.light) * (-optics_[row].diffuse_view);
  };
  accumulate([&](size_t row) { return rows_[row].color - far_reflected(row) - constant(row); }, out);
}

std::vector<SplitSystem::ViewError> SplitSystem::errors_of_views(const SplitUnknowns& x) const {
  const Sky sky = sky_change(x.light);
  std::vector<std::vector<ViewError>> parts(chunks_.size(), std::vector<ViewError>(size_t(views_)));
  parallel_for(int(chunks_.size()), [&](int chunk) {
    for (size_t i = chunks_[size_t(chunk)].begin; i < chunks_[size_t(chunk)].end; ++i) {
      const SplitRow& row = rows_[i];
      if (row.held_out != (options_.hold_out > 0)) continue;
      const Vec3f e = predict(i, x, sky) + far_reflected(i) - row.color;
      ViewError& of_view = parts[size_t(chunk)][row.view];
      of_view.count += 3 * row.trust;
      for (int c = 0; c < 3; ++c) {
        if ((row.clipped >> c & 1) && e[c] > 0) continue;
        of_view.sum += double(row.weight[c]) * e[c] * e[c];
      }
    }
  });
  std::vector<ViewError> out = parts.front();
  for (const std::vector<ViewError>& part : std::span(parts).subspan(1))
    for (size_t v = 0; v < out.size(); ++v) out[v].sum += part[v].sum, out[v].count += part[v].count;
  return out;
}

double SplitSystem::residual(const SplitUnknowns& x) const {
  ViewError all;
  for (const ViewError& e : errors_of_views(x)) all.sum += e.sum, all.count += e.count;
  return all.mean();
}

SplitUnknowns SplitSystem::diagonal() const {
  SplitUnknowns d;
  d.diffuse.assign(mesh_.positions.size(), {0, 0, 0});
  d.light.assign(cells(), {0, 0, 0});
  std::array<std::vector<Vec3f>, BlurLadder::kLevels> mass;
  for (auto& m : mass) m.assign(cells(), {0, 0, 0});
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SplitRow& row = rows_[i];
    const Optics& o = optics_[i];
    const Vec3f gg = row.weight * o.sky_gain() * o.sky_gain(), here = row.diffuse_light;
    for (int k = 0; k < 3; ++k)
      d.diffuse[row.vertices[k]] += row.weight * here * here * square(row.barycentric[k] * o.diffuse_view);
    const size_t level = size_t(o.base.lobe.level) + (o.base.lobe.above > 0.5f);
    for (size_t k = 0; k < 4; ++k) mass[level][o.base.pixel[k]] += gg * o.base.weight[k];
  }
  for (int level = 0; level < BlurLadder::kLevels; ++level) {
    if (!in_use_[size_t(level)]) continue;
    std::vector<Vec3f> light;
    blurs_.level(level).apply_squared_transposed(mass[size_t(level)], light);
    for (size_t i = 0; i < cells(); ++i) d.light[i] += light[i];
  }
  return d;
}

std::vector<Vec3f> SplitSystem::fit_metal_color(const SplitUnknowns& x) {
  const Blurred sky = sky_of(x.light).blurred;
  // Ratios of sums: in least squares, errors of the light would bias all colors to dark.
  const size_t n = mesh_.positions.size();
  std::vector<Vec3f> above(n, Vec3f{0, 0, 0}), below(n, Vec3f{0, 0, 0});
  for (size_t i = 0; i < rows_.size(); ++i) {
    const SplitRow& row = rows_[i];
    const Optics& o = optics_[i];
    const ReflectedParts<float> reflected =
        reflected_parts(o.split_sum, incident_at(sky, o.base, row), incident_at(sky, o.fresnel, row));
    for (int k = 0; k < 3; ++k) {
      above[row.vertices[k]] += weights_[i] * (row.color - reflected.fresnel) * row.barycentric[k];
      below[row.vertices[k]] += weights_[i] * reflected.base * row.barycentric[k];
    }
  }
  // Regularization: a small weight towards the mean color, which unseen vertices take.
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

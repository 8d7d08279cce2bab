// SPDX-License-Identifier: Apache-2.0
// The operator of the linear separation against its adjoint, and the solution against that of the dense
// equations.
#include "engine/reconstruct/appearance/split_system.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {

struct SplitSystemProbe {
  // What rows see of the unknowns, without what they see of none.
  static std::vector<Vec3f> predict(const SplitSystem& s, const SplitUnknowns& x) {
    return rows(s, x, s.sky_of(x.light));
  }
  // What rows see of no unknowns.
  static std::vector<Vec3f> constant(const SplitSystem& s, const SplitUnknowns& zero) {
    std::vector<Vec3f> out = rows(s, zero, s.sky_change(zero.light));
    for (size_t i = 0; i < out.size(); ++i) out[i] += s.far_reflected(i);
    return out;
  }
  static SplitUnknowns normal(const SplitSystem& s, const SplitUnknowns& x) {
    SplitUnknowns out;
    s.normal(x, out);
    return out;
  }
  static SplitUnknowns right_side(const SplitSystem& s) {
    SplitUnknowns out;
    s.right_side(out);
    return out;
  }
  static const std::vector<Vec3f>& weights(const SplitSystem& s) { return s.weights_; }
  static float light_smoothness(const SplitSystem& s) { return s.light_smoothness_; }
  static float diffuse_smoothness(const SplitSystem& s) { return s.diffuse_smoothness_; }

 private:
  static std::vector<Vec3f> rows(const SplitSystem& s, const SplitUnknowns& x, const SplitSystem::Sky& sky) {
    std::vector<Vec3f> out(s.rows_.size(), Vec3f{0, 0, 0});
    for (size_t i = 0; i < out.size(); ++i) out[i] = s.predict(i, x, sky);
    return out;
  }
};

namespace {

using Probe = SplitSystemProbe;
constexpr int kRows = 600, kHeight = 6;

Vec3f random_color(Rng& rng) { return {0.5f + rng.uniform(), 0.5f + rng.uniform(), 0.5f + rng.uniform()}; }

std::array<float, 3> random_barycentrics(Rng& rng) {
  const float u = rng.uniform(), v = rng.uniform();
  return u + v > 1 ? barycentrics(1 - u, 1 - v) : barycentrics(u, v);
}

std::vector<SplitRow> random_rows(const Mesh& mesh) {
  std::vector<SplitRow> rows(kRows);
  for (uint64_t i = 0; i < kRows; ++i) {
    Rng rng(1, 0, i);
    SplitRow& row = rows[i];
    row = {};
    row.vertices = mesh.triangles[rng.below(uint32_t(mesh.triangles.size()))];
    row.barycentric = random_barycentrics(rng);
    row.normal = fibonacci_direction(int(i), kRows);
    row.to_camera = normalize(row.normal + Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.4f);
    row.nv = dot(row.normal, row.to_camera);
    for (float& h : row.hidden) h = i % 3 == 0 ? 0.0f : rng.uniform();
    row.trust = 1;
    row.far_color = random_color(rng);
    row.color = random_color(rng);
    row.weight = random_color(rng);
    row.diffuse_light = random_color(rng);
    row.far_diffuse_light = random_color(rng);
    row.held_out = i % 17 == 0;
  }
  return rows;
}

// Some vertices are metals.
SplitMaterials random_materials(size_t vertices) {
  SplitMaterials m = one_material(vertices, {0.4f, 0.5f, 0});
  for (size_t v = 0; v < vertices; ++v) {
    Rng rng(2, 0, v);
    m.of[v].roughness = 0.2f + 0.6f * rng.uniform();
    m.of[v].metalness = v % 4 == 0 ? 1 : 0;
    m.color[v] = random_color(rng);
  }
  return m;
}

DiffuseLightGrad random_grad() {
  DiffuseLightGrad grad{std::vector<DiffuseLightGrad::OfRow>(kRows), {}};
  for (uint64_t i = 0; i < kRows; ++i) {
    Rng rng(3, 0, i);
    for (float& h : grad.rows[i].d_light) h = rng.normal();
    grad.rows[i].gain = random_color(rng) * 0.2f;
  }
  Rng rng(4, 0, 0);
  for (Vec3f& h : grad.light) h = random_color(rng);
  return grad;
}

LinearSplitOptions small() {
  LinearSplitOptions o;
  o.light_height = kHeight;
  o.smoothness = 0.02f;
  return o;
}

struct Problem {
  Mesh mesh = sphere_mesh(4, 7);
  std::vector<SplitRow> rows = random_rows(mesh);
  SplitSystem system{mesh, rows, small()};

  explicit Problem(bool turning) {
    system.set_materials(random_materials(mesh.positions.size()));
    if (turning) system.set_diffuse_light_grad(random_grad());
  }
  bool is_metal(uint32_t v) const { return system.materials().is_metal(v); }
  size_t vertices() const { return mesh.positions.size(); }
  size_t unknowns() const { return vertices() + size_t(2) * kHeight * kHeight; }
  SplitUnknowns zero() const {
    const Vec3f none{0, 0, 0};
    return {std::vector<Vec3f>(vertices(), none), std::vector<Vec3f>(unknowns() - vertices(), none)};
  }
  // D of the vertices first, then the light.
  static Vec3f& at(SplitUnknowns& x, size_t i) {
    return i < x.diffuse.size() ? x.diffuse[i] : x.light[i - x.diffuse.size()];
  }
  SplitUnknowns random(uint64_t seed) const {
    SplitUnknowns x = zero();
    for (size_t i = 0; i < unknowns(); ++i) {
      Rng rng(seed, 0, i);
      if (i >= vertices() || !is_metal(uint32_t(i))) at(x, i) = random_color(rng);
    }
    return x;
  }
};

Vec3d product(SplitUnknowns a, SplitUnknowns b) {
  Vec3d sum{0, 0, 0};
  for (size_t i = 0; i < a.diffuse.size() + a.light.size(); ++i)
    sum += to_double(Problem::at(a, i)) * to_double(Problem::at(b, i));
  return sum;
}

Vec3d weighted_product(const std::vector<Vec3f>& w, const std::vector<Vec3f>& a,
                       const std::vector<Vec3f>& b) {
  Vec3d sum{0, 0, 0};
  for (size_t i = 0; i < a.size(); ++i) sum += to_double(w[i]) * to_double(a[i]) * to_double(b[i]);
  return sum;
}

// <A' W A x, y> = <W A x, A y>, and <A' W c, y> = <W c, A y>.
TEST(SplitSystem, TheAdjointBelongsToTheOperator) {
  for (const bool turning : {false, true}) {
    const Problem p(turning);
    const std::vector<Vec3f>& w = Probe::weights(p.system);
    const SplitUnknowns x = p.random(10), y = p.random(11);
    const std::vector<Vec3f> of_x = Probe::predict(p.system, x), of_y = Probe::predict(p.system, y);
    const Vec3d got = product(Probe::normal(p.system, x), y), want = weighted_product(w, of_x, of_y);
    std::vector<Vec3f> target = Probe::constant(p.system, p.zero());
    for (size_t i = 0; i < target.size(); ++i) target[i] = p.rows[i].color - target[i];
    const Vec3d got_right = product(Probe::right_side(p.system), y),
                want_right = weighted_product(w, target, of_y);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(got[c], want[c], 1e-5 * std::abs(want[c])) << turning;
      EXPECT_NEAR(got_right[c], want_right[c], 1e-5 * std::abs(want_right[c])) << turning;
    }
  }
}

using Matrix = std::vector<std::vector<double>>;

void add_link(Matrix& m, size_t a, size_t b, double weight) {
  m[a][a] += weight, m[b][b] += weight;
  m[a][b] -= weight, m[b][a] -= weight;
}

// Weighted squares of the predictions of every unknown alone, and those of differences of neighbors.
Matrix dense_matrix(const Problem& p, int channel) {
  const size_t n = p.unknowns(), v = p.vertices();
  std::vector<std::vector<Vec3f>> columns;
  for (size_t i = 0; i < n; ++i) {
    SplitUnknowns unit = p.zero();
    if (i >= v || !p.is_metal(uint32_t(i))) Problem::at(unit, i) = {1, 1, 1};
    columns.push_back(Probe::predict(p.system, unit));
  }
  const std::vector<Vec3f>& w = Probe::weights(p.system);
  Matrix m(n, std::vector<double>(n, 0));
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) m[i][j] = weighted_product(w, columns[i], columns[j])[channel];
  for (const auto& t : p.mesh.triangles)
    for (int c = 0; c < 3; ++c) {
      const uint32_t a = t[c], b = t[(c + 1) % 3];
      if (a < b && !p.is_metal(a) && !p.is_metal(b)) add_link(m, a, b, Probe::diffuse_smoothness(p.system));
    }
  for (size_t y = 0; y < kHeight; ++y)
    for (size_t x = 0; x < 2 * kHeight; ++x) {
      const size_t row = v + y * 2 * kHeight;
      add_link(m, row + x, row + (x + 1) % (2 * kHeight), Probe::light_smoothness(p.system));
      if (y + 1 < kHeight) add_link(m, row + x, row + 2 * kHeight + x, Probe::light_smoothness(p.system));
    }
  for (size_t i = 0; i < v; ++i)
    if (p.is_metal(uint32_t(i))) m[i][i] = 1;  // is no unknown
  return m;
}

// m: symmetric, positive definite.
std::vector<double> solved(Matrix m, std::vector<double> x) {
  const size_t n = x.size();
  for (size_t k = 0; k < n; ++k)
    for (size_t i = k + 1; i < n; ++i) {
      const double f = m[i][k] / m[k][k];
      for (size_t j = k; j < n; ++j) m[i][j] -= f * m[k][j];
      x[i] -= f * x[k];
    }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; ++j) x[k] -= m[k][j] * x[j];
    x[k] /= m[k][k];
  }
  return x;
}

TEST(SplitSystem, SolvesTheDenseEquations) {
  for (const bool turning : {false, true}) {
    Problem p(turning);
    const SplitUnknowns truth = p.random(12);
    const std::vector<Vec3f> seen = Probe::predict(p.system, truth),
                             constant = Probe::constant(p.system, p.zero());
    for (size_t i = 0; i < kRows; ++i) {
      Rng rng(13, 0, i);
      p.rows[i].color = (seen[i] + constant[i]) * (1 + 0.02f * rng.normal());
    }
    SplitUnknowns x = p.random(14);
    p.system.solve(x, 2, 150);
    for (int c = 0; c < 3; ++c) {
      std::vector<double> right(p.unknowns());
      SplitUnknowns b = Probe::right_side(p.system);
      for (size_t i = 0; i < right.size(); ++i) right[i] = Problem::at(b, i)[c];
      const std::vector<double> want = solved(dense_matrix(p, c), right);
      double error = 0, size = 0;
      for (size_t i = 0; i < want.size(); ++i) {
        EXPECT_GE(want[i], 0);  // the bounds do not bind
        error += square(Problem::at(x, i)[c] - want[i]);
        size += square(want[i]);
      }
      EXPECT_LT(std::sqrt(error / size), 2e-3) << turning;
    }
  }
}

}  // namespace
}  // namespace cei3d

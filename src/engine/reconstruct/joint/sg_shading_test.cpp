// SPDX-License-Identifier: Apache-2.0
// The paper's shading against an implementation of its own in PyTorch, whose values and derivatives are
// stored: tests/oracles/paper_shading.py.
#include "engine/reconstruct/joint/sg_shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"
#include "core/base/test_source.h"
#include "engine/reconstruct/joint/test_probe.h"

namespace cei3d {
namespace {

using Numbers = std::vector<double>;

Vec3f vector_at(const Numbers& v, size_t i) {
  return {float(v[3 * i]), float(v[3 * i + 1]), float(v[3 * i + 2])};
}
std::vector<Vec3f> vectors(const Numbers& v) {
  std::vector<Vec3f> out;
  for (size_t i = 0; i < v.size() / 3; ++i) out.push_back(vector_at(v, i));
  return out;
}
Vec3f tangent(Vec3f d, Vec3f n) { return d - n * dot(n, d); }

class PaperShading : public testing::Test {
 protected:
  static Json oracle() { return parse_json(read_file(source_file("tests/oracles/paper_shading.json"))); }
  Numbers input(const char* name) const { return oracle_["inputs"][name].get<Numbers>(); }
  Numbers derivative(const char* name) const { return oracle_["derivatives"][name].get<Numbers>(); }
  float number(const char* name) const { return float(input(name)[0]); }

  SgMaterial material() const {
    return {number("sharpness"), vector_at(input("amplitude"), 0), number("roughness"), number("specular"),
            number("metalness")};
  }
  SgMixture light() const {
    SgMixture out;
    for (size_t k = 0; k < axes_.size(); ++k)
      out.lobes.push_back({axes_[k], float(input("lambdas")[k]), vector_at(input("mus"), k)});
    return out;
  }
  std::vector<Hit> hits() const {
    const std::vector<Vec3f> views = vectors(input("views"));
    std::vector<Hit> out;
    for (size_t i = 0; i < normals_.size(); ++i) out.push_back({{0, 0, 0}, normals_[i], views[i], 0, 0, 0});
    return out;
  }
  // Within 1e-3 of the greatest of them.
  static void expect_vectors(std::span<const Vec3f> got, std::span<const Vec3f> want, const char* what) {
    ASSERT_EQ(got.size(), want.size()) << what;
    float greatest = 0;
    for (const Vec3f w : want) greatest = std::max(greatest, std::sqrt(dot(w, w)));
    for (size_t i = 0; i < want.size(); ++i)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[i][c], want[i][c], 1e-3f * greatest) << what << " " << i;
  }

  Device device_ = make_device();
  const Json oracle_ = oracle();
  const std::vector<Vec3f> normals_ = vectors(input("normals")), axes_ = vectors(input("axes")),
                           albedo_ = vectors(input("albedo"));
  SgShading shading_{device_, material(), 1e-3f};
  const std::vector<Hit> hits_ = hits();
  const UniformBatch batch_{hits_, Material{}};
};

TEST_F(PaperShading, RadianceIsThatOfPyTorch) {
  const std::vector<ShadingTerms<float>> terms = shading_.terms(light(), batch_);
  std::vector<Vec3f> radiance;
  for (size_t i = 0; i < terms.size(); ++i) radiance.push_back(terms[i].radiance(albedo_[i]));
  expect_vectors(radiance, vectors(oracle_["radiance"].get<Numbers>()), "radiance");
}

TEST_F(PaperShading, DerivativesAreThoseOfPyTorch) {
  shading_.terms(light(), batch_);
  const ShadingGrads grads = shading_.grad(batch_, albedo_, vectors(oracle_["weights"].get<Numbers>()));
  expect_vectors(grads.d_albedo, vectors(derivative("albedo")), "albedo");

  std::vector<Vec3f> d_normals = vectors(derivative("normals"));
  for (size_t i = 0; i < d_normals.size(); ++i) d_normals[i] = tangent(d_normals[i], normals_[i]);
  expect_vectors(grads.d_normal, d_normals, "normal");

  std::vector<Vec3f> d_axes, want_axes, d_mu, d_lambda, want_lambda;
  const std::vector<float>& d_lobes = shading_.lobes_grad();
  for (size_t k = 0; k < axes_.size(); ++k) {
    d_axes.push_back(tangent(load_planes<float>(d_lobes.data(), kPanel, int(k)), axes_[k]));
    want_axes.push_back(tangent(vector_at(derivative("axes"), k), axes_[k]));
    d_lambda.push_back({d_lobes[3 * size_t(kPanel) + k], 0, 0});
    want_lambda.push_back({float(derivative("lambdas")[k]), 0, 0});
    d_mu.push_back(load_planes<float>(d_lobes.data() + 4 * kPanel, kPanel, int(k)));
  }
  expect_vectors(d_axes, want_axes, "axis");
  expect_vectors(d_lambda, want_lambda, "lambda");
  expect_vectors(d_mu, vectors(derivative("mus")), "mu");
}

// The material descends on logarithms and logits.
TEST_F(PaperShading, DerivativesOfTheMaterialAreThoseOfPyTorch) {
  shading_.terms(light(), batch_);
  shading_.grad(batch_, albedo_, vectors(oracle_["weights"].get<Numbers>()));
  const auto logarithm = [](double value) { return value; };
  const auto logit = [](double value) { return value * (1 - value); };
  Numbers want;
  const auto add = [&](const char* name, const auto& slope) {
    const Numbers at = input(name), d = derivative(name);
    for (size_t i = 0; i < at.size(); ++i) want.push_back(d[i] * slope(at[i]));
  };
  add("sharpness", logarithm);
  add("amplitude", logarithm);
  for (const char* name : {"roughness", "specular", "metalness"}) add(name, logit);
  const std::vector<float> got = JointDescentProbe::gloss_gradient(shading_);
  ASSERT_GE(got.size(), want.size());
  for (size_t i = 0; i < want.size(); ++i)
    EXPECT_NEAR(double(got[i]), want[i], 2e-3 * std::abs(want[i]) + 5e-6) << i;
}

}  // namespace
}  // namespace cei3d

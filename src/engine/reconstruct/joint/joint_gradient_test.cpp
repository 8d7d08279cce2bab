// SPDX-License-Identifier: Apache-2.0
// The gradient that a step of the joint descent accumulates, for every group of parameters, against
// differences of its loss: rays are traced, shaded and compared with the pictures again with changed
// parameters.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/reconstruct/joint/test_ball.h"
#include "engine/reconstruct/joint/test_probe.h"
#include "engine/reconstruct/test_directions.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {
namespace {

using Probe = JointDescentProbe;

// Almost a sphere: convex, so that nothing is reflected twice. No grid, so that nothing has kinks.
Field pebble() {
  FieldConfig c;
  c.encoding.frequencies = 2;
  c.width = 16;
  c.activation = Activation::softplus;
  c.softplus_beta = 10;
  c.outputs = 1;
  c.sphere_radius = 0.65f;
  Field field(c, 4);
  for (Param& p : field.params().all())
    for (float& v : p.value) v *= 0.35f;
  return field;
}

Field smooth_colors(int outputs) {
  FieldConfig c;
  c.encoding.frequencies = 2;
  c.width = 16;
  c.activation = Activation::softplus;
  c.softplus_beta = 10;
  c.outputs = outputs;
  c.output_activation = Activation::sigmoid;
  return Field(c, 6);
}

class JointGradient : public testing::Test {
 protected:
  void make(const MaterialField& material, SpecularTerm specular = SpecularTerm::split_sum) {
    JointObject object{pebble(), smooth_colors(3), material, studio()};
    const PixelStore gray = pictures_of(device_, object, surface_of(object.sdf), {6, 32});
    seen_ = extract_surface_and_hits(device_, object.sdf, {48}, gray, 100000, Progress());
    // Rays that graze the surface meet it or miss it: no derivative tells.
    std::erase_if(seen_.hits.hits, [](const Hit& h) { return dot(h.normal, h.to_camera) < 0.45f; });
    // Brighter than all that the object looks like, so that the slopes of pixels do not cancel.
    seen_.hits.colors.assign(seen_.hits.hits.size(), Vec3f{2, 2, 2});
    pixels_ = gray;
    input_ = {seen_.surface, SurfaceSamples{seen_.hits.hits, seen_.hits.colors, {}}};
    JointOptions options;
    options.rays = 256;
    options.box_points = options.near_points = 64;
    options.mask_rays = 256;
    options.mask_sharpness = 60;
    options.learn_specular = true;
    options.specular = specular;
    descent_ =
        std::make_unique<JointDescent>(device_, input_, pixels_, std::move(object), options, Progress());
    step_ = Probe::accumulate(*descent_);
    ASSERT_GT(step_.hits.size(), 200u);
  }
  std::shared_ptr<const Surface> surface_of(const Field& sdf) {
    return std::make_shared<const Surface>(extract_mesh(device_, sdf, {48}));
  }
  // `slope` against the central difference of the loss under change(step), which must be undone by change(0).
  void expect_slope(double slope, const std::function<void(float)>& change, float step,
                    const std::string& what) {
    change(step);
    const double more = Probe::accumulate(*descent_).loss.total();
    change(-step);
    const double less = Probe::accumulate(*descent_).loss.total();
    change(0);
    const double want = (more - less) / (2 * double(step));
    EXPECT_NEAR(slope, want, 0.03 * std::abs(want) + 2e-4) << what;
    EXPECT_GT(std::abs(want), 1e-3) << what << " does not matter";
  }
  // Along a few random directions in the space of each tensor.
  using GradientOf = std::span<const float> (*)(JointDescent&, const Param&);
  void expect_field(ParamSet& params, GradientOf gradient_of, float step, const std::string& what) {
    std::vector<std::vector<float>> gradients;  // before further ones are added
    for (const Param& p : params.all()) {
      const std::span<const float> g = gradient_of(*descent_, p);
      gradients.emplace_back(g.begin(), g.end());
    }
    for (size_t t = 0; t < params.all().size(); ++t) {
      Param& p = params.all()[t];
      const std::vector<float> before = p.value;
      const TensorDirection direction(std::span(gradients[t]).first(p.count()), t);
      const auto change = [&](float h) {
        for (size_t i = 0; i < direction.of.size(); ++i) p.value[i] = before[i] + h * direction.of[i];
      };
      expect_slope(direction.slope, change, step, what + " " + p.name);
    }
  }

  // Of three lobes of light: of their axes, sharpness and color. gradient: planes as of lobes_grad().
  void expect_light(const SgMixture& light, const std::vector<float>& gradient) {
    const int padded = kPanel;
    for (size_t k = 0; k < 3; ++k) {
      const SgLobe& lobe = light.lobes[k];
      const Vec3f d_axis = load_planes<float>(gradient.data(), padded, int(k)),
                  tangent = normalize(d_axis - lobe.axis * dot(lobe.axis, d_axis));
      const auto change = [&](const std::function<void(SgLobe&)>& move) {
        SgMixture moved = light;
        move(moved.lobes[k]);
        Probe::set_light(*descent_, moved);
      };
      const std::string name = " of lobe " + std::to_string(k);
      expect_slope(
          dot(d_axis, tangent),
          [&](float h) { change([&](SgLobe& l) { l.axis = normalize(l.axis + tangent * h); }); }, 0.02f,
          "axis" + name);
      expect_slope(
          double(gradient[3 * size_t(padded) + k]) * lobe.lambda,
          [&](float h) { change([&](SgLobe& l) { l.lambda *= 1 + h; }); }, 0.02f, "sharpness" + name);
      expect_slope(
          dot(load_planes<float>(gradient.data() + 4 * padded, padded, int(k)), lobe.mu),
          [&](float h) { change([&](SgLobe& l) { l.mu = l.mu * (1 + h); }); }, 0.02f, "color" + name);
    }
  }

  Device device_ = make_device();
  SurfaceAndHits seen_;
  PixelStore pixels_;
  AppearanceInput input_;
  std::unique_ptr<JointDescent> descent_;
  Probe::Step step_;
};

TEST_F(JointGradient, OfTheDistanceFieldEqualsDifferencesOfTheLoss) {
  make(Material{0.35f, 0.5f, 0.3f});
  expect_field(Probe::sdf(*descent_), &Probe::sdf_gradient, 2e-3f, "distance");
}

TEST_F(JointGradient, OfTheAlbedoEqualsDifferencesOfTheLoss) {
  make(Material{0.35f, 0.5f, 0.3f});
  expect_field(Probe::albedo(*descent_), &Probe::albedo_gradient, 5e-3f, "albedo");
}

TEST_F(JointGradient, OfVaryingMaterialEqualsDifferencesOfTheLoss) {
  make({Material{0.35f, 0.5f, 0.3f}, std::make_shared<const Field>(smooth_colors(MaterialField::kOutputs))});
  expect_field(Probe::materials(*descent_), &Probe::materials_gradient, 5e-3f, "material");
}

TEST_F(JointGradient, OfOneMaterialEqualsDifferencesOfTheLoss) {
  make(Material{0.35f, 0.4f, 0.3f});
  const std::span<const float> now = Probe::logits_gradient(*descent_);
  const std::vector<float> gradient(now.begin(), now.end()), before = Probe::logits(*descent_).value;
  for (size_t k = 0; k < 3; ++k) {
    const auto change = [&](float h) {
      Probe::logits(*descent_).value[k] = before[k] + h;
      Probe::use_logits(*descent_);
    };
    expect_slope(gradient[k], change, 0.02f, std::vector{"roughness", "specular", "metalness"}[k]);
  }
}

TEST_F(JointGradient, OfTheLightEqualsDifferencesOfTheLoss) {
  make(Material{0.35f, 0.5f, 0.3f});
  const SgMixture light = studio();
  const int padded = kPanel;
  std::vector<float> planes(size_t(7) * padded, 0.0f);
  for (size_t k = 0; k < light.lobes.size(); ++k) {
    store_planes(planes.data(), padded, int(k), light.lobes[k].axis);
    planes[3 * size_t(padded) + k] = light.lobes[k].lambda;
    store_planes(planes.data() + 4 * padded, padded, int(k), light.lobes[k].mu);
  }
  const std::vector<float> gradient =
      lobes_grad(device_, {planes.data(), int(light.lobes.size()), padded}, {step_.hits, step_.materials},
                 step_.grads.d_sky_irradiance, step_.grads.d_sky_reflection);
  expect_light(light, gradient);
}

TEST_F(JointGradient, OfASingleGaussianEqualsDifferencesOfTheLoss) {
  make(Material{0.35f, 0.5f, 0.3f}, SpecularTerm::single_sg);
  const std::vector<float> gradient = Probe::gloss_gradient(*descent_),
                           lobes = Probe::gloss_lobes_gradient(*descent_), before = Probe::gloss(*descent_);
  expect_field(Probe::sdf(*descent_), &Probe::sdf_gradient, 2e-3f, "distance");
  for (size_t k = 0; k < 7; ++k) {
    const auto change = [&](float h) { Probe::gloss(*descent_)[k] = before[k] + h; };
    expect_slope(gradient[k], change, 0.02f, "number " + std::to_string(k) + " of the material");
  }
  expect_light(studio(), lobes);
}

}  // namespace
}  // namespace cei3d

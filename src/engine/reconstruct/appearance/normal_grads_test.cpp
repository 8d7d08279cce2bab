// SPDX-License-Identifier: Apache-2.0
// The derivatives that polishing hands to the geometry stage against differences of its loss: hits are shaded
// again with the normals of a changed field.
#include "engine/reconstruct/appearance/normal_grads.h"

#include <gtest/gtest.h>

#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {
namespace {

constexpr float kStep = 2e-3f, kWeight = 1.5f, kAlbedo = 0.5f;
const Material kGlossy{0.35f, 0.5f, 0.4f};

// Exactly the sphere, which is what makes its gradient a unit vector, plus `size` times smooth noise.
Field bumpy(float size) {
  FieldConfig c;
  c.encoding.frequencies = 2;
  c.width = 16;
  c.activation = Activation::softplus;
  c.softplus_beta = 5;
  c.outputs = 1;
  c.sphere_radius = kSphereRadius;
  Field field(c, 3);
  std::vector<Param>& params = field.params().all();
  for (Param& p : params)
    if (p.name.starts_with("layer1"))
      for (size_t i = 0; i < p.count(); ++i) p.value[i] = size * Rng(8, 0, i).normal();
  return field;
}

std::shared_ptr<const Field> gray() {
  FieldConfig c;
  c.output_activation = Activation::sigmoid;
  auto field = std::make_shared<Field>(c, 1);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  return field;
}

class NormalGradsTest : public testing::Test {
 protected:
  NormalGradsTest() {
    const Scene scene = sphere_scene();
    for (const Hit& h : trace_view(device_, scene, camera_towards_origin({2, -2, 1}, 64), 1).hits)
      if (dot(h.normal, h.to_camera) > 0.3f) hits_.push_back(h);
    photo_.assign(hits_.size(), Vec3f{2, 2, 2});  // brighter than all hits, so that their grads do not cancel
    input_ = {scene.surface, SurfaceSamples{hits_, photo_, {}}};
    look_.light = scene.light;
    look_.material = kGlossy;
    look_.albedo = gray();
    lighting_ = std::make_unique<Lighting>(
        device_, scene.surface, scene.light,
        std::vector<Vec3f>(scene.surface->mesh().positions.size(), Vec3f{kAlbedo, kAlbedo, kAlbedo}),
        kGlossy);
  }

  // Loss of hits whose normals are those of a field.
  double loss(const Field& sdf, std::span<const Hit> on_sphere) const {
    std::vector<Hit> hits(on_sphere.begin(), on_sphere.end());
    std::vector<Vec3f> normals(hits.size());
    sdf_normals(device_, sdf, positions_of(hits), normals);
    for (size_t i = 0; i < hits.size(); ++i) hits[i].normal = normals[i];
    const std::vector<Material> materials(hits.size(), kGlossy);
    const std::vector<Vec3f> albedo(hits.size(), Vec3f{kAlbedo, kAlbedo, kAlbedo});
    const Shading s = lighting_->shade({hits, materials}, albedo);
    double sum = 0;
    for (size_t i = 0; i < hits.size(); ++i)
      for (int c = 0; c < 3; ++c) sum += display_loss(s.diffuse[i][c] + s.specular[i][c], 2.0f).value;
    return kWeight * sum / double(hits.size());
  }

  Device device_ = make_device();
  std::vector<Hit> hits_;
  std::vector<Vec3f> photo_;
  AppearanceInput input_;
  AppearanceResult look_;
  std::unique_ptr<Lighting> lighting_;
};

TEST_F(NormalGradsTest, EqualDifferencesOfTheShadingLoss) {
  PolishOptions options;
  options.batch = 512;
  options.weight = kWeight;
  NormalGrads grads(device_, input_, look_, options, Progress());
  const ValueGradSpans got = grads.at(bumpy(0), 0);
  const Field more = bumpy(kStep), less = bumpy(-kStep);
  const std::vector<float> f_more = first_output(device_, more, got.points),
                           f_less = first_output(device_, less, got.points);
  double slope = 0;
  for (size_t i = 0; i < got.points.size(); ++i)
    slope += double(got.d_values[i]) * (f_more[i] - f_less[i]) / (2 * kStep);
  const double want = (loss(more, grads.hits()) - loss(less, grads.hits())) / (2 * double(kStep));
  EXPECT_GT(std::abs(want), 1e-2);
  EXPECT_NEAR(slope, want, 0.02 * std::abs(want));
}

}  // namespace
}  // namespace cei3d

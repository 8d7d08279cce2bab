// SPDX-License-Identifier: Apache-2.0
// The gradient that a training step accumulates, for every parameter of both networks, against the same loss
// written down once more in double and derived by dual numbers: hash grid, networks, jets, opacities,
// compositing, losses. Only the choice of rays and samples is taken from the stage.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/composite.h"
#include "core/math/dual.h"
#include "core/math/encoding.h"
#include "core/math/loss.h"
#include "core/math/volume.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/test_box.h"

namespace cei3d {

struct GeometryStageProbe {
  struct Chunk {
    RayBatch batch;
    RaySamples samples;
  };
  // What the next step renders. Its rays depend on the errors recorded so far: call this before step().
  static std::vector<Chunk> chunks(GeometryStage& stage, double u) {
    stage.refresh_grid(0, u, Progress());
    const GeometryStage::Step step = stage.step_at(0, u);
    std::vector<Chunk> out;
    for (int c = 0; c < stage.options_.rays / kChunkRays; ++c) {
      GeometryStage::Work w(stage.options_);
      stage.sample_training_rays(step, c, w);
      out.push_back({w.batch, w.samples});
    }
    return out;
  }
  static GeometryStats accumulate(GeometryStage& stage, double u, const ValueGradSpans& more) {
    return stage.accumulate(stage.step_at(0, u), more);
  }
  static ParamSet& sdf(GeometryStage& stage) { return stage.sdf_.params(); }
  static const ParamSet& radiance(GeometryStage& stage) { return stage.radiance_; }
  static std::span<const float> gradient(GeometryStage& stage, const Param& p) {
    return stage.optimizer_.gradient(p);
  }
};

namespace {

using P = Dual<double>;  // derivative by a parameter
using S = Dual<P>;       // derivative by a parameter and a coordinate of a point
using Params = std::vector<std::vector<P>>;

constexpr uint64_t kSeed = 5;
constexpr double kPosition = 0.05;  // in the schedule: the start shape is held

Params params_of(const ParamSet& set) {
  Params out;
  for (const Param& p : set.all()) {
    out.emplace_back();
    for (size_t i = 0; i < p.count(); ++i) out.back().push_back(P(double(p.value[i])));
  }
  return out;
}

// Layers are params[first], params[first + 1], ...: weight, bias, weight, bias, ...
template <class T, class Activate>
std::vector<T> layers(const Params& params, size_t first, std::vector<T> x, const Activate& activate) {
  for (size_t l = first; l < params.size(); l += 2) {
    std::vector<T> y;
    for (size_t o = 0; o < params[l + 1].size(); ++o) {
      T sum(params[l + 1][o], P(0.0));
      for (size_t i = 0; i < x.size(); ++i) sum += x[i] * T(params[l][o * x.size() + i], P(0.0));
      y.push_back(l + 2 < params.size() ? activate(sum) : sum);
    }
    x = std::move(y);
  }
  return x;
}

// The same for numbers without a derivative by coordinates.
std::vector<P> radiance_layers(const Params& params, std::vector<P> x) {
  for (size_t l = 0; l < params.size(); l += 2) {
    std::vector<P> y = params[l + 1];
    for (size_t o = 0; o < y.size(); ++o) {
      for (size_t i = 0; i < x.size(); ++i) y[o] += params[l][o * x.size() + i] * x[i];
      y[o] = l + 2 < params.size() ? Relu::eval(y[o], 1).value : Sigmoid::eval(y[o], 1).value;
    }
    x = std::move(y);
  }
  return x;
}

struct Jet {
  std::vector<P> outputs;
  Vec3<P> gradient;  // of output 0
};

class Reference {
 public:
  Reference(const GeometryOptions& options, const DistanceGrid& start, const ParamSet& sdf,
            const ParamSet& radiance)
      : params_sdf(params_of(sdf)), params_radiance(params_of(radiance)), options_(options), start_(start) {}
  Params params_sdf, params_radiance;

  Jet jet(Vec3f p) const {
    Jet out;
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<S> y = field(p, axis);
      out.gradient[axis] = y[0].derivative;
      if (axis == 0)
        for (const S& v : y) out.outputs.push_back(v.value);
    }
    return out;
  }
  P distance(Vec3f p) const { return field(p, 0)[0].value; }

  // Loss of the rays and their samples; the weights are those of GeometryOptions.
  P rays_loss(const GeometryStageProbe::Chunk& chunk, const GeometrySchedule& s) const {
    P sum(0.0);
    for (int r = 0; r < chunk.batch.count(); ++r) sum += ray_loss(chunk, r, s);
    return sum;
  }
  P hold_loss(const GeometrySchedule& s) const {
    constexpr int kPoints = 512;
    P sum(0.0);
    for (const Vec3f x : hold_points(start_, kSeed, 0, kPoints))
      sum += P(2.0 * s.anchor / kPoints) * huber(distance(x) - P(double(start_.at(x))), P(0.02)).value;
    return sum;
  }

 private:
  std::vector<S> field(Vec3f p, int axis) const {
    const EncodingConfig& e = options_.sdf.encoding;
    Vec3<S> x{S(double(p.x)), S(double(p.y)), S(double(p.z))};
    x[axis].derivative = P(1.0);
    std::vector<S> in{x.x, x.y, x.z};
    for (int l = 0; l < e.levels; ++l) {
      const GridLevel level = grid_level(e, l);
      const GridCell<S> cell(level, x);
      for (size_t j = 0; j < 2; ++j) {
        S feature(0.0);
        for (int k = 0; k < 8; ++k)
          feature += cell.weight(k) * S(params_sdf[l][2 * cell.corner(level, k) + j], P(0.0));
        in.push_back(feature);
      }
    }
    const float beta = options_.sdf.softplus_beta;
    std::vector<S> y =
        layers<S>(params_sdf, size_t(e.levels), in, [beta](S z) { return Softplus::eval(z, beta).value; });
    y[0] += length(x) - S(double(options_.sdf.sphere_radius));
    return y;
  }

  Vec3<P> color(const Jet& jet, Vec3f p, Vec3f direction) const {
    const auto constant = [](Vec3f v) { return Vec3<P>{P(double(v.x)), P(double(v.y)), P(double(v.z))}; };
    const Vec3<P> n = jet.gradient / length(jet.gradient), x = constant(p), d = constant(direction);
    const P nv = -dot(n, d);
    const Vec3<P> mirrored = d + n * (P(2.0) * nv);
    std::vector<P> in(jet.outputs.begin() + 1, jet.outputs.end());
    for (const Vec3<P>& v : {n, x, d})
      for (int c = 0; c < 3; ++c) in.push_back(v[c]);
    in.push_back(nv);
    for (int c = 0; c < 3; ++c) in.push_back(mirrored[c]);
    for (int octave = 0; octave < 4; ++octave)
      for (int c = 0; c < 3; ++c) {
        in.push_back(sin(P(double(1 << octave)) * mirrored[c]));
        in.push_back(cos(P(double(1 << octave)) * mirrored[c]));
      }
    const std::vector<P> rgb = radiance_layers(params_radiance, in);
    return {rgb[0], rgb[1], rgb[2]};
  }

  P ray_loss(const GeometryStageProbe::Chunk& chunk, int r, const GeometrySchedule& s) const {
    const Ray& ray = chunk.batch.rays[r];
    const Vec3f background = chunk.batch.backgrounds[r], target = chunk.batch.targets[r].srgb;
    const P inv_s(double(s.inv_s)), per_ray(1.0 / options_.rays);
    Composite<P> pixel({P(double(background.x)), P(double(background.y)), P(double(background.z))});
    P loss(0.0);
    for (int i = chunk.samples.first[r]; i < chunk.samples.first[r + 1]; ++i) {
      const Vec3f p = ray.origin + ray.direction * chunk.samples.depths[i];
      const Jet j = jet(p);
      P cosine(0.0);
      for (int c = 0; c < 3; ++c) cosine += j.gradient[c] * P(double(ray.direction[c]));
      const P alpha = neus_alpha(j.outputs[0], cosine, P(double(s.step)), inv_s).alpha;
      pixel.add(alpha, color(j, p, s.view_dependent ? ray.direction : Vec3f{0, 0, 0}));
      loss += P(options_.loss.eikonal * 0.25) * eikonal(j.gradient).value;
      if (chunk.batch.empty[r])
        loss += P(double(options_.loss.empty)) * inv_s * empty_push(j.outputs[0], s.inv_s).value;
      if (s.anchor > 0)
        loss += P(double(s.anchor)) * huber(j.outputs[0] - P(double(start_.at(p))), P(0.02)).value;
    }
    for (int c = 0; c < 3; ++c)
      loss += huber(pixel.pixel[c] - P(double(target[c])), P(double(options_.loss.huber_width))).value;
    return loss * per_ray;
  }

  const GeometryOptions& options_;
  const DistanceGrid& start_;
};

PixelStore box_views() {
  PixelStore store;
  for (int v = 0; v < 5; ++v) {
    const Camera camera = box_camera(-0.3 + 0.2 * v, 1.3 * v, 20);
    const auto color_at = [](Vec3f p) { return p.x > 0 ? Vec3f{0.9f, 0.1f, 0} : Vec3f{0, 0.3f, 0.8f}; };
    store.add_view(camera, box_picture(camera, color_at), 3);
  }
  return store;
}

// A ball that is too large beside the faces of the box, so that rays through background meet it, and too
// small at its corners.
DistanceGrid ball() {
  DistanceGrid grid{24, {}};
  for (int i = 0; i < grid.n * grid.n * grid.n; ++i) {
    const auto at = [&](int k) { return (float(k) + 0.5f) * 2 / float(grid.n) - 1; };
    const Vec3f p{at(i % grid.n), at(i / grid.n % grid.n), at(i / grid.n / grid.n)};
    grid.values.push_back(length(p) - 0.58f);
  }
  return grid;
}

GeometryOptions tiny_networks() {
  GeometryOptions o;
  o.sdf.encoding = {
      .frequencies = 0, .levels = 2, .base_resolution = 4, .finest_resolution = 9, .log2_table = 9};
  o.sdf.hidden_layers = 1;
  o.sdf.width = 8;
  o.sdf.activation = Activation::softplus;
  o.sdf.softplus_beta = 20;
  o.sdf.outputs = 4;
  o.sdf.sphere_radius = 0.5f;
  o.radiance_layers = 1;
  o.radiance_width = 8;
  o.rays = 2 * kChunkRays;
  o.inv_s_start = 60;
  o.prefit_steps = 60;
  return o;
}

struct Setting {
  const char* name;
  GeometryOptions options = tiny_networks();
  bool anchored = false;
  float matte_until = 0;
  bool value_grads = false;  // somebody else's loss, too
};

class GradientOf {
 public:
  explicit GradientOf(const Setting& setting)
      : setting_(setting), stage_(device_, pixels_, setting.options, kSeed) {
    stage_.prefit({start_, setting.anchored, setting.matte_until});
    // So that neither features nor their derivatives are small.
    for (Param& p : GeometryStageProbe::sdf(stage_).all())
      if (p.name.starts_with("encoding"))
        for (size_t i = 0; i < p.count(); ++i) p.value[i] += 0.05f * Rng(9, 1, i).normal();
    for (uint64_t i = 0; setting.value_grads && i < 600; ++i) {
      Rng rng(7, 0, i);
      points_.push_back(Vec3f{rng.uniform(), rng.uniform(), rng.uniform()} * 1.6f - Vec3f{0.8f, 0.8f, 0.8f});
      value_grads_.push_back(0.1f * rng.normal());
    }
    chunks_ = GeometryStageProbe::chunks(stage_, kPosition);
    stats_ = GeometryStageProbe::accumulate(stage_, kPosition, {points_, value_grads_});
  }

  void expect_samples() const {
    int empty = 0, backgrounds = 0;
    for (const auto& chunk : chunks_)
      for (int r = 0; r < chunk.batch.count(); ++r) {
        const int n = chunk.samples.first[r + 1] - chunk.samples.first[r];
        (chunk.batch.empty[r] ? empty : backgrounds) += n;
      }
    EXPECT_GT(empty, 15);
    EXPECT_GT(backgrounds, 60);
  }

  void expect_equal() {
    Reference reference(setting_.options, start_, GeometryStageProbe::sdf(stage_),
                        GeometryStageProbe::radiance(stage_));
    EXPECT_NEAR(stats_.loss, loss(reference, false).value, 1e-4 * stats_.loss) << setting_.name;
    compare(GeometryStageProbe::sdf(stage_), reference, reference.params_sdf);
    compare(GeometryStageProbe::radiance(stage_), reference, reference.params_radiance);
  }

 private:
  P loss(const Reference& reference, bool value_grads = true) const {
    GeometrySchedule s = schedule_at(setting_.options, kPosition);
    s.view_dependent = kPosition >= setting_.matte_until;
    if (!setting_.anchored && !setting_.options.hold_start) s.anchor = 0;
    P sum(0.0);
    for (const auto& chunk : chunks_) sum += reference.rays_loss(chunk, s);
    if (setting_.options.hold_start) sum += reference.hold_loss(s);
    for (size_t i = 0; value_grads && i < points_.size(); ++i)
      sum += P(double(value_grads_[i])) * reference.distance(points_[i]);
    return sum;
  }

  // Those with the largest gradients, and some at even distances.
  static std::vector<size_t> entries(std::span<const float> gradient, size_t count) {
    constexpr size_t kLargest = 3, kSpread = 2;
    std::vector<size_t> order(count);
    std::iota(order.begin(), order.end(), size_t(0));
    std::ranges::stable_sort(
        order, [&](size_t a, size_t b) { return std::abs(gradient[a]) > std::abs(gradient[b]); });
    order.resize(std::min(count, kLargest));
    for (size_t i = 0; i < count; i += 1 + count / kSpread) order.push_back(i);
    return order;
  }

  // The stage works in float: a distance is known to about 1e-7, an opacity to inv_s = 60 times that, and
  // sums over some hundred samples, of either sign, to a few 1e-5 of the largest gradient of a tensor. Any
  // wrong sign or missing term is off by a good part of it.
  void compare(const ParamSet& set, const Reference& reference, Params& params) {
    for (size_t p = 0; p < params.size(); ++p) {
      const Param& param = set.all()[p];
      const std::span<const float> gradient = GeometryStageProbe::gradient(stage_, param);
      double scale = 0;
      for (size_t i = 0; i < param.count(); ++i) scale = std::max(scale, double(std::abs(gradient[i])));
      EXPECT_GT(scale, 0) << param.name;
      for (const size_t i : entries(gradient, param.count())) {
        params[p][i].derivative = 1;
        EXPECT_NEAR(gradient[i], loss(reference).derivative, 5e-4 * scale)
            << setting_.name << ": " << param.name << " " << i;
        params[p][i].derivative = 0;
      }
    }
  }

  Setting setting_;
  Device device_ = make_device();
  PixelStore pixels_ = box_views();
  DistanceGrid start_ = ball();
  GeometryStage stage_;
  std::vector<Vec3f> points_;
  std::vector<float> value_grads_;
  std::vector<GeometryStageProbe::Chunk> chunks_;
  GeometryStats stats_;
};

void expect_gradient(const Setting& setting) {
  GradientOf gradient(setting);
  gradient.expect_samples();
  gradient.expect_equal();
}

// The losses other than the color's are made to outweigh it in turn, so that none hides behind another.
TEST(GeometryGradient, OfTheColorLossOverRandomBackgrounds) {
  Setting s{"color"};
  s.options.loss.eikonal = s.options.loss.empty = 0;
  expect_gradient(s);
}

TEST(GeometryGradient, WhileColorsDoNotDependOnTheView) {
  Setting s{"matte"};
  s.matte_until = 0.5f;
  s.options.loss.eikonal = s.options.loss.empty = 0;
  expect_gradient(s);
}

TEST(GeometryGradient, OfTheEikonalLoss) {
  Setting s{"eikonal"};
  s.options.loss.eikonal = 100;
  expect_gradient(s);
}

TEST(GeometryGradient, OfTheLossOfSurfacesOnEmptyRays) {
  Setting s{"empty"};
  s.options.loss.empty = 10;
  expect_gradient(s);
}

TEST(GeometryGradient, OfTheAnchorAtSamples) {
  Setting s{"anchor"};
  s.anchored = true;
  s.options.loss.anchor = 10;
  expect_gradient(s);
}

TEST(GeometryGradient, OfTheHeldStart) {
  Setting s{"hold"};
  s.options.hold_start = true;
  s.options.loss.anchor = 10;
  expect_gradient(s);
}

TEST(GeometryGradient, OfAllTogetherAndALossFromOutside) {
  Setting s{"all"};
  s.anchored = s.options.hold_start = s.value_grads = true;
  expect_gradient(s);
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/geometry_stage.h"

#include <algorithm>
#include <cmath>

#include "core/base/aligned.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "core/math/sub_pixel.h"
#include "core/math/volume.h"

namespace cei3d {

namespace {

constexpr int kRays = 64;          // a chunk
constexpr int kKept = kRays * 32;  // most samples of a chunk that get jets; about five a ray are usual
constexpr int kKeptPerRay = 64, kCandidates = 320;  // most of a ray: one that grazes the object needs them
constexpr int kBlock = 512;                         // candidates evaluated at a time,
constexpr int kGlance = 8;                          // of a ray
constexpr float kAnchorWidth = 0.02f;               // of its loss
const Vec3f kWhite{1, 1, 1};

}  // namespace

double GeometryStats::psnr() const {
  return -10 * std::log10(std::max(squared_error / double(std::max<int64_t>(rays, 1)), 1e-12));
}

struct GeometryStage::RayBatch {
  int count = 0;
  std::vector<size_t> pixels;  // in their store
  std::vector<Ray> rays;
  std::vector<Target> targets;
  std::vector<Vec3f> backgrounds;  // display-encoded; what a ray shows where it meets nothing
  std::vector<uint8_t> empty;      // the picture shows that it meets nothing
};

struct GeometryStage::Work {
  Work(const FieldConfig& sdf, const MlpConfig& radiance)
      : value(sdf, kBlock, 1),
        jet(sdf, kKept, 4),
        color(radiance, kKept, 1),
        block_points(kBlock * 3),
        points(kKept * 3),
        directions(kKept * 3),
        d_color_input(size_t(kKept) * radiance.inputs) {}
  FieldPass value, jet;
  MlpPass color;
  std::vector<float> depths, values;  // candidates of all rays, ray after ray; only some get a value
  std::vector<int> ray_of;            // #candidates
  int looked_at = 0;                  // candidates with a value
  AlignedVector<float> block_points;
  std::vector<float> kept_depth;             // #kept
  std::vector<int> first_kept;               // #rays + 1
  int padded = 0;                            // kept samples, rounded up to a panel
  AlignedVector<float> points, directions;   // panels [3][32]
  std::vector<NeusSample<float>> alpha;      // #kept
  std::vector<float> weight, transmittance;  // #kept
  std::vector<Vec3f> pixel;                  // #rays: composite over white
  std::vector<float> coverage;               // #rays
  AlignedVector<float> d_color_input;
};

GeometryStage::GeometryStage(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
                             uint64_t seed)
    : device_(device),
      pixels_(pixels),
      options_(options),
      seed_(seed),
      sdf_(options.sdf, seed),
      radiance_config_{radiance_rows(options.sdf.outputs - 1),
                       options.radiance_layers,
                       options.radiance_width,
                       -1,
                       Activation::relu,
                       1,
                       3,
                       Activation::sigmoid},
      errors_(pixels.pixels().size()),
      work_([this] { return std::make_unique<Work>(options_.sdf, radiance_config_); }),
      sdf_gradients_(options.rays / kRays),
      radiance_gradients_(options.rays / kRays) {
  add_mlp_params(radiance_config_, radiance_, seed + 1);
  Optimizer::Group tables{options.table_rate}, layers{options.layer_rate};
  tables.skip_zero = true;
  optimizer_.add(sdf_.params(), "encoding/", tables);
  optimizer_.add(sdf_.params(), "layer", layers);
  optimizer_.add(radiance_, "layer", layers);
}

GeometryStage::~GeometryStage() = default;

void GeometryStage::prefit(const StartShape& start) {
  cei3d::prefit(device_, sdf_, start.distance, options_.prefit_steps, options_.layer_rate, levels_at(0),
                seed_);
  anchor_ = start.anchored || options_.hold_start ? start.distance : DistanceGrid{};
  matte_until_ = start.matte_until;
}

int GeometryStage::levels_at(double u) const {
  const int all = options_.sdf.encoding.levels, first = std::min(options_.first_levels, all);
  return std::min(all, first + int((all - first + 1) * u / options_.unlock_until));
}

GeometryStage::Schedule GeometryStage::schedule_at(double u) const {
  const double p = std::min(1.0, u / options_.sharpness_until);
  Schedule s;
  s.sharpness = float(options_.sharpness_start *
                      std::pow(double(options_.sharpness_end) / options_.sharpness_start, p));
  s.step = std::clamp(options_.step_width / s.sharpness, options_.step_min, options_.step_max);
  s.band = std::max(4 / s.sharpness, 1.5f * s.step);
  // Before, the surface moves and bends between two looks at the grid: as little slack from the start costs
  // lego400 half a decibel (docs/notebook/0013).
  s.slack = rests_at(u) ? 0.25f : 1;
  s.levels = levels_at(u);
  s.views = u >= matte_until_;
  s.anchor = anchor_.n
                 ? options_.anchor_weight * s.sharpness * float(std::max(0.0, 1 - u / options_.anchor_until))
                 : 0;
  return s;
}

void GeometryStage::sample_rays(const PixelStore& store, int64_t step, int first, bool training,
                                RayBatch& batch) const {
  batch.count = kRays;
  batch.pixels.resize(kRays);
  batch.rays.resize(kRays);
  batch.targets.resize(kRays);
  batch.backgrounds.assign(kRays, kWhite);
  batch.empty.assign(kRays, 0);
  for (int r = 0; r < kRays; ++r) {
    Rng rng(seed_, uint64_t(step), uint64_t(first + r));
    batch.pixels[r] = training ? errors_.choose(rng) : rng.below(uint32_t(store.pixels().size()));
    const Pixel& p = store.pixels()[batch.pixels[r]];
    // Not spread over the pixel: each ray is compared with the whole pixel, so that would blur it once more.
    batch.rays[r] = store.ray(p);
    batch.targets[r] = target_of(p);
    if (!training) continue;
    batch.empty[r] = batch.targets[r].alpha == 0;
    // Each ray before a colour of its own: only matter that covers it looks right before all of them.
    const Vec3f background{rng.uniform(), rng.uniform(), rng.uniform()};
    batch.backgrounds[r] = background;
    batch.targets[r].srgb += (background - kWhite) * (1 - batch.targets[r].alpha);
  }
}

namespace {

// Candidates of a ray, front to back, with the field's values there.
struct Candidates {
  std::span<const float> depths, values;
  float step, sharpness;

  float alpha(size_t i) const {
    const bool joined_before = i > 0 && depths[i] - depths[i - 1] < 1.5f * step;
    const bool joined_after = i + 1 < depths.size() && depths[i + 1] - depths[i] < 1.5f * step;
    const float half_slope = joined_after    ? 0.5f * (values[i + 1] - values[i])
                             : joined_before ? 0.5f * (values[i] - values[i - 1])
                                             : -0.35f * step;
    const float before = joined_before ? 0.5f * (values[i] + values[i - 1]) : values[i] - half_slope;
    const float after = values[i] + half_slope;
    const float p = Sigmoid::eval(sharpness * before, 1).value, q = Sigmoid::eval(sharpness * after, 1).value;
    return std::clamp((p - q) / (p + 1e-5f), 0.0f, 1.0f);
  }
};

// Those that carry weight. Where the picture shows background (`empty`), also those inside the surface,
// however little light reaches them.
void select_samples(const Candidates& c, float keep_weight, bool empty, std::vector<float>& kept) {
  float transmittance = 1;
  const size_t end = std::min(kept.size() + kKeptPerRay, size_t(kKept));
  for (size_t i = 0; i < c.depths.size() && kept.size() < end && (empty || transmittance > keep_weight);
       ++i) {
    const float alpha = c.alpha(i), weight = transmittance * alpha;
    if (weight > keep_weight || (empty && c.values[i] < 0)) kept.push_back(c.depths[i]);
    transmittance *= 1 - alpha;
  }
}

}  // namespace

void GeometryStage::find_values(const Schedule& s, const RayBatch& batch, std::span<const int> candidates,
                                Work& w) const {
  for (size_t begin = 0; begin < candidates.size(); begin += kBlock) {
    const auto block = candidates.subspan(begin, std::min(size_t(kBlock), candidates.size() - begin));
    const int count = int(block.size()), padded = (count + kPanel - 1) / kPanel * kPanel;
    for (int i = 0; i < padded; ++i) {
      const int k = block[std::min(i, count - 1)];
      const Ray& ray = batch.rays[w.ray_of[k]];
      const Vec3f p = ray.origin + ray.direction * w.depths[k];
      for (int c = 0; c < 3; ++c) w.block_points[panel_at(i, 1, 0, 3, c)] = p[c];
    }
    w.value.forward(device_, sdf_, *sdf_weights_, w.block_points.data(), padded, s.levels, 1);
    for (int i = 0; i < count; ++i)
      w.values[block[i]] = w.value.output()[panel_at(i, 1, 0, options_.sdf.outputs, 0)];
  }
}

void GeometryStage::gather_samples(const Schedule& s, const RayBatch& batch, Work& w, uint64_t jitter_key,
                                   bool training) const {
  w.depths.clear();
  w.ray_of.clear();
  std::vector<float> jitter(batch.count, 0.5f);
  if (training)
    for (int r = 0; r < batch.count; ++r) jitter[r] = Rng(seed_ ^ 0x5eed, jitter_key, uint64_t(r)).uniform();
  std::vector<int> counts(batch.count), first{0}, alive;
  grid_.march({batch.rays.data(), size_t(batch.count)}, {s.step, s.band, s.slack, kCandidates}, jitter,
              w.depths, counts);
  for (int r = 0; r < batch.count; ++r) {
    first.push_back(first.back() + counts[r]);
    w.ray_of.resize(first.back(), r);
    alive.push_back(r);
  }
  w.values.resize(w.depths.size());

  // A few of each ray at a time, until nothing gets through: what lies behind needs no value.
  struct Looked {
    int count = 0, passed = 0;
    float transmittance = 1;  // behind those passed
  };
  std::vector<Looked> looked(batch.count);
  const auto candidates = [&](int r) {
    const size_t n = size_t(looked[r].count);
    return Candidates{{&w.depths[first[r]], n}, {&w.values[first[r]], n}, s.step, s.sharpness};
  };
  const auto sees_all = [&](int r) { return training && batch.empty[r]; };
  w.looked_at = 0;
  for (std::vector<int> next; !alive.empty(); next.clear()) {
    for (const int r : alive)
      for (int k = 0; k < kGlance && first[r] + looked[r].count < first[r + 1]; ++k)
        next.push_back(first[r] + looked[r].count++);
    find_values(s, batch, next, w);
    w.looked_at += int(next.size());
    std::erase_if(alive, [&](int r) {
      Looked& l = looked[r];
      while (l.passed + 1 < l.count)  // the last one's slope needs the next
        l.transmittance *= 1 - candidates(r).alpha(size_t(l.passed++));
      return first[r] + l.count == first[r + 1] || (!sees_all(r) && l.transmittance <= options_.keep_weight);
    });
  }

  w.kept_depth.clear();
  w.first_kept.assign(1, 0);
  for (int r = 0; r < batch.count; ++r) {
    if (looked[r].count > 0) select_samples(candidates(r), options_.keep_weight, sees_all(r), w.kept_depth);
    w.first_kept.push_back(int(w.kept_depth.size()));
  }
}

void GeometryStage::forward(const Schedule& s, const RayBatch& batch, Work& w) const {
  const int kept = int(w.kept_depth.size());
  w.padded = (kept + kPanel - 1) / kPanel * kPanel;
  int ray = 0;
  for (int i = 0; i < w.padded; ++i) {
    while (i < kept && i >= w.first_kept[ray + 1]) ++ray;
    const Ray& r = batch.rays[ray];
    const Vec3f p = i < kept ? r.origin + r.direction * w.kept_depth[i] : Vec3f{0, 0, 0};
    for (int c = 0; c < 3; ++c) {
      w.points[panel_at(i, 1, 0, 3, c)] = p[c];
      w.directions[panel_at(i, 1, 0, 3, c)] = s.views ? r.direction[c] : 0;
    }
  }
  w.jet.forward(device_, sdf_, *sdf_weights_, w.points.data(), w.padded, s.levels, options_.sdf.outputs);
  device_.launch<RadianceInput>({w.points.data(), w.directions.data(), const_cast<float*>(w.jet.output()),
                                 nullptr, w.color.input(), options_.sdf.outputs - 1},
                                w.padded);
  w.color.forward(device_, *radiance_weights_, w.padded, radiance_config_.inputs, 3);
  composite(s, batch, w);
}

void GeometryStage::composite(const Schedule& s, const RayBatch& batch, Work& w) const {
  const int kept = int(w.kept_depth.size()), rows = options_.sdf.outputs;
  w.alpha.resize(kept);
  w.weight.resize(kept);
  w.transmittance.resize(kept);
  w.pixel = batch.backgrounds;
  w.coverage.assign(batch.count, 0);
  for (int r = 0; r < batch.count; ++r) {
    float transmittance = 1;
    for (int i = w.first_kept[r]; i < w.first_kept[r + 1]; ++i) {
      const float f = w.jet.output()[panel_at(i, 4, 0, rows, 0)];
      const float cosine = dot(load_sdf_gradient<float>(w.jet.output(), i, rows), batch.rays[r].direction);
      w.alpha[i] = neus_alpha<float>(f, cosine, s.step, s.sharpness);
      w.transmittance[i] = transmittance;
      w.weight[i] = transmittance * w.alpha[i].alpha;
      transmittance *= 1 - w.alpha[i].alpha;
      for (int c = 0; c < 3; ++c)
        w.pixel[r][c] += w.weight[i] * (w.color.output()[panel_at(i, 1, 0, 3, c)] - batch.backgrounds[r][c]);
      w.coverage[r] += w.weight[i];
    }
  }
}

namespace {

// Slope of the penalty on being inside, softplus(-f), at a point on a ray that shows background. The colour
// loss cannot open a gap that has closed: where a ray is opaque its opacity does not change with the distance
// any more, but this still does.
float empty_push(float sdf, float sharpness) { return -Softplus::eval(-sdf, sharpness).first; }

}  // namespace

void GeometryStage::backward(const Schedule& s, const RayBatch& batch, Work& w, ChunkGradients& g,
                             std::vector<float>& radiance, GeometryStats& stats) const {
  const int rows = options_.sdf.outputs;
  const float per_ray = 1.0f / float(options_.rays),
              per_sample = per_ray / 4;  // about four samples a ray are kept
  float* d_jet = w.jet.d_output();
  float* d_color = w.color.d_output();
  std::fill(d_jet, d_jet + size_t(w.padded) * 4 * rows, 0.0f);
  std::fill(d_color, d_color + size_t(w.padded) * 3, 0.0f);
  for (int r = 0; r < batch.count; ++r) {
    Vec3f d_pixel;
    for (int c = 0; c < 3; ++c) {
      const float e = w.pixel[r][c] - batch.targets[r].srgb[c];
      const LossValue<float> l = huber(e, options_.huber_width);
      d_pixel[c] = l.gradient * per_ray;
      stats.color += l.value;
      stats.squared_error += e * e / 3;
    }
    // Watched, but no loss: it would never rest, since coverage is always a little below one
    // (docs/decisions/0020).
    stats.mask += std::abs(w.coverage[r] - batch.targets[r].alpha);
    const float push = batch.empty[r] ? options_.empty_weight * s.sharpness * per_ray : 0;
    float behind = 0;  // sum of weight x d_weight over the samples behind
    for (int i = w.first_kept[r + 1] - 1; i >= w.first_kept[r]; --i) {
      float d_weight = 0;
      for (int c = 0; c < 3; ++c) {
        const float color = w.color.output()[panel_at(i, 1, 0, 3, c)];
        d_weight += d_pixel[c] * (color - batch.backgrounds[r][c]);
        d_color[panel_at(i, 1, 0, 3, c)] = d_pixel[c] * w.weight[i];
      }
      const float d_alpha = w.transmittance[i] * d_weight - behind / std::max(1 - w.alpha[i].alpha, 1e-4f);
      behind += w.weight[i] * d_weight;
      const Vec3f gradient = load_sdf_gradient<float>(w.jet.output(), i, rows);
      Vec3f d_gradient;
      stats.eikonal += eikonal(gradient, d_gradient);
      const float sdf = w.jet.output()[panel_at(i, 4, 0, rows, 0)];
      float d_sdf = d_alpha * w.alpha[i].d_sdf + push * empty_push(sdf, s.sharpness);
      if (s.anchor > 0) {
        const Vec3f x{w.points[panel_at(i, 1, 0, 3, 0)], w.points[panel_at(i, 1, 0, 3, 1)],
                      w.points[panel_at(i, 1, 0, 3, 2)]};
        d_sdf += s.anchor * per_ray * huber(sdf - anchor_.at(x), kAnchorWidth).gradient;
      }
      d_jet[panel_at(i, 4, 0, rows, 0)] = d_sdf;
      for (int c = 0; c < 3; ++c)
        d_jet[panel_at(i, 4, 1 + c, rows, 0)] = d_alpha * w.alpha[i].d_cosine * batch.rays[r].direction[c] +
                                                options_.eikonal_weight * per_sample * d_gradient[c];
    }
  }
  radiance.assign(radiance_weights_->gradient_size(), 0.0f);
  w.color.backward(device_, *radiance_weights_, w.padded, radiance_config_.inputs, radiance.data(),
                   w.d_color_input.data());
  device_.launch<RadianceInputGrad>(
      {w.points.data(), w.directions.data(), d_jet, w.jet.output(), w.d_color_input.data(), rows - 1},
      w.padded);
  g.reset(options_.sdf, sdf_weights_->gradient_size(), w.padded, 4);
  std::copy(w.points.begin(), w.points.begin() + std::ptrdiff_t(w.padded) * 3, g.points.begin());
  w.jet.backward(device_, *sdf_weights_, w.padded, s.levels, g.network.data(), g.d_encoding.data());
  stats.kept += int64_t(w.kept_depth.size());
  stats.candidates += w.looked_at;
  stats.rays += batch.count;
}

namespace {
void add(GeometryStats& a, const GeometryStats& b) {
  a.color += b.color;
  a.mask += b.mask;
  a.eikonal += b.eikonal;
  a.squared_error += b.squared_error;
  a.kept += b.kept;
  a.candidates += b.candidates;
  a.rays += b.rays;
}
}  // namespace

template <class SlopeOf>
void GeometryStage::add_slopes(const Schedule& s, std::span<const Vec3f> x, const SlopeOf& slope_of, Work& w,
                               ChunkGradients& g) const {
  const int n = int(x.size()), padded = (n + kPanel - 1) / kPanel * kPanel;
  const int rows = options_.sdf.outputs;
  g.reset(options_.sdf, sdf_weights_->gradient_size(), padded, 1);
  points_to_panels(x.data(), n, g.points.data());
  w.value.forward(device_, sdf_, *sdf_weights_, g.points.data(), padded, s.levels, rows);
  float* d_value = w.value.d_output();
  std::fill(d_value, d_value + size_t(padded) * rows, 0.0f);
  for (int i = 0; i < n; ++i) {
    const int at = panel_at(i, 1, 0, rows, 0);
    d_value[at] = slope_of(i, w.value.output()[at]);
  }
  w.value.backward(device_, *sdf_weights_, padded, s.levels, g.network.data(), g.d_encoding.data());
}

// Also where no ray looks any more: what is gone has no samples that could bring it back.
void GeometryStage::hold_start(const Schedule& s, int64_t step, Work& w, ChunkGradients& g) const {
  constexpr float kNear = 0.08f, kWeight = 2;  // of the surface; as much as so many samples a ray
  constexpr int kTries = 16;
  std::vector<Vec3f> x(kBlock);
  for (int i = 0; i < kBlock; ++i) {
    Rng rng(seed_ ^ 0x401d, uint64_t(step), uint64_t(i));
    for (int k = 0; k < kTries && (k == 0 || std::abs(anchor_.at(x[i])) > kNear); ++k)
      x[i] = Vec3f{rng.uniform(), rng.uniform(), rng.uniform()} * 2.0f - Vec3f{1, 1, 1};
  }
  const float weight = kWeight * s.anchor / float(kBlock);
  add_slopes(
      s, x,
      [&](int i, float value) { return weight * huber(value - anchor_.at(x[i]), kAnchorWidth).gradient; }, w,
      g);
}

// Cells that rays reach change what they sample, the others only how far they leap.
void GeometryStage::refresh_grid(const Schedule& s, int64_t step, double u) {
  constexpr int kFull = 40;  // one look in so many
  const int wide = rests_at(u) ? 10 : 3;
  const int64_t look = step / options_.refresh_every;
  grid_.refresh(device_, sdf_,
                look % kFull == 0  ? 1e9f
                : look % wide == 0 ? 0.15f
                                   : s.band + grid_.half_diagonal());
}

GeometryStats GeometryStage::step(int64_t step, double u, const ValueSlopes& more) {
  const Schedule s = schedule_at(u);
  if (step % options_.refresh_every == 0)
    StepTimes::process(times_, StepPart::occupancy, [&] { refresh_grid(s, step, u); });
  sdf_weights_ = std::make_unique<MlpWeights>(mlp_config(options_.sdf), sdf_.params());
  radiance_weights_ = std::make_unique<MlpWeights>(radiance_config_, radiance_);
  const int chunks = options_.rays / kRays;
  const int more_chunks = (int(more.points.size()) + kBlock - 1) / kBlock;
  const int hold_chunks = options_.hold_start && s.anchor > 0;
  sdf_gradients_.resize(chunks + more_chunks + hold_chunks);
  std::vector<GeometryStats> stats(chunks);
  std::vector<std::pair<size_t, float>> seen(options_.rays);  // pixel, squared error
  parallel_for(chunks + more_chunks + hold_chunks, [&](int c) {
    if (c >= chunks + more_chunks) {
      work_.with([&](Work& w) { hold_start(s, step, w, sdf_gradients_[c]); });
      return;
    }
    if (c >= chunks) {
      const int first = (c - chunks) * kBlock, n = std::min(kBlock, int(more.points.size()) - first);
      const auto slope_of = [&](int i, float) { return more.slopes[first + i]; };
      work_.with(
          [&](Work& w) { add_slopes(s, more.points.subspan(first, n), slope_of, w, sdf_gradients_[c]); });
      return;
    }
    RayBatch batch;
    sample_rays(pixels_, step, c * kRays, true, batch);
    work_.with([&](Work& w) {
      StepTimes::thread(times_, StepPart::march,
                        [&] { gather_samples(s, batch, w, uint64_t(step) * 4096 + uint64_t(c), true); });
      StepTimes::thread(times_, StepPart::forward, [&] { forward(s, batch, w); });
      StepTimes::thread(times_, StepPart::backward,
                        [&] { backward(s, batch, w, sdf_gradients_[c], radiance_gradients_[c], stats[c]); });
      for (int r = 0; r < kRays; ++r) {
        const Vec3f off = w.pixel[r] - batch.targets[r].srgb;
        seen[size_t(c) * kRays + r] = {batch.pixels[r], dot(off, off)};
      }
    });
  });
  for (const auto& [pixel, error] : seen) errors_.saw(pixel, error);
  std::vector<const std::vector<float>*> radiance;
  for (const auto& g : radiance_gradients_) radiance.push_back(&g);
  accumulate_layers(radiance_, radiance, optimizer_);
  StepTimes::process(times_, StepPart::scatter,
                     [&] { accumulate_gradients(device_, sdf_, sdf_gradients_, s.levels, optimizer_); });

  const double warm_up = std::min(1.0, u / 0.02 + 0.01);
  const double decay =
      u < options_.decay_from
          ? 1.0
          : std::pow(double(options_.decay_to), (u - options_.decay_from) / (1 - options_.decay_from));
  StepTimes::process(times_, StepPart::adam, [&] { optimizer_.step(device_, float(warm_up * decay)); });
  GeometryStats total;
  for (const GeometryStats& st : stats) add(total, st);
  return total;
}

GeometryStats GeometryStage::evaluate(const PixelStore& held_out, int rays, double u) {
  const Schedule s = schedule_at(u);
  sdf_weights_ = std::make_unique<MlpWeights>(mlp_config(options_.sdf), sdf_.params());
  radiance_weights_ = std::make_unique<MlpWeights>(radiance_config_, radiance_);
  const int chunks = rays / kRays;
  std::vector<GeometryStats> stats(chunks);
  parallel_for(chunks, [&](int c) {
    RayBatch batch;
    sample_rays(held_out, -1, c * kRays, false, batch);
    work_.with([&](Work& w) {
      gather_samples(s, batch, w, 0, false);
      forward(s, batch, w);
      for (int r = 0; r < batch.count; ++r) {
        const Vec3f e = w.pixel[r] - batch.targets[r].srgb;
        stats[c].squared_error += dot(e, e) / 3;
        ++stats[c].rays;
      }
    });
  });
  GeometryStats total;
  for (const GeometryStats& st : stats) add(total, st);
  return total;
}

Image GeometryStage::render_radiance(const Camera& camera, int samples) {
  const Schedule s = schedule_at(1);
  sdf_weights_ = std::make_unique<MlpWeights>(mlp_config(options_.sdf), sdf_.params());
  radiance_weights_ = std::make_unique<MlpWeights>(radiance_config_, radiance_);
  Image out(camera.width, camera.height, 3);
  const int per_pixel = samples * samples, pixels = kRays / per_pixel, all = camera.width * camera.height;
  if (pixels < 1) fail("render_radiance: at most 8 samples a pixel and axis");
  parallel_for((all + pixels - 1) / pixels, [&](int c) {
    RayBatch batch;
    for (int i = c * pixels; i < std::min(all, (c + 1) * pixels); ++i)
      for (int k = 0; k < per_pixel; ++k) {
        const Vec2f at = sub_pixel(k, samples);
        batch.rays.push_back(camera.ray(i % camera.width + at.x, i / camera.width + at.y));
      }
    batch.count = int(batch.rays.size());
    batch.backgrounds.assign(batch.count, kWhite);
    work_.with([&](Work& w) {
      gather_samples(s, batch, w, 0, false);
      forward(s, batch, w);
      for (int r = 0; r < batch.count; ++r) {
        const int i = c * pixels + r / per_pixel;
        for (int k = 0; k < 3; ++k) out.data[size_t(i) * 3 + k] += w.pixel[r][k] / float(per_pixel);
      }
    });
  });
  return out;
}

void GeometryStage::save(Tensors& out) const {
  sdf_.params().save(out, "sdf");
  radiance_.save(out, "radiance");
  optimizer_.save(out, "adam");
  const int64_t n = grid_.resolution();
  out["pixel_errors"] = {{int64_t(errors_.runs().size())}, errors_.runs(), {}};
  out["matte_until"] = {{1}, {matte_until_}, {}};
  if (anchor_.n) out["anchor"] = {{anchor_.n, anchor_.n, anchor_.n}, anchor_.values, {}};
  out["occupancy"] = {
      {n, n, n}, grid_.values(), {}};  // stale cells and all: resuming then equals never stopping
}

void GeometryStage::load(const Tensors& in) {
  sdf_.params().load(in, "sdf");
  radiance_.load(in, "radiance");
  optimizer_.load(in, "adam");
  const int64_t n = grid_.resolution();
  grid_.set(require_tensor(in, "occupancy", {n, n, n}).f32);
  errors_.set_runs(require_tensor(in, "pixel_errors", {int64_t(errors_.runs().size())}).f32);
  matte_until_ = require_tensor(in, "matte_until", {1}).f32[0];
  if (const auto anchor = in.find("anchor"); anchor != in.end() && !anchor->second.shape.empty()) {
    const int64_t cells = anchor->second.shape[0];
    anchor_ = {int(cells), require_tensor(in, "anchor", {cells, cells, cells}).f32};
  }
}

}  // namespace cei3d

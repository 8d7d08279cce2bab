// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "core/math/psnr.h"
#include "engine/reconstruct/poses/align_views.h"
#include "engine/reconstruct/poses/refined_cameras.h"

namespace cei3d {

namespace {

constexpr double kReportSeconds = 2;
// Between evaluations on held-out pixels: at least 2 s, and 40 times as long as the last one took.
constexpr double kEvaluationSeconds = 2, kEvaluationShare = 40;
// Positions in the schedule at which poses that were moved before, and exposures, are fitted to what was
// trained, and the share of the training that the poses may take. Those of the last fit are the poses of the
// object: more precise ones gain more than the steps that they cost.
struct Fit {
  double at, align_share;
};
constexpr std::array<Fit, 5> kFits{{{0.1, 0.07}, {0.2, 0.07}, {0.3, 0.07}, {0.45, 0.07}, {0.6, 0.2}}};
// Maximum sides of the images that are compared, pixels. Of those for alignment the largest for which there
// is time, by how long the last one took; a first one has kFirstAlignSide.
constexpr std::array kAlignSides{320, 160};
constexpr int kFirstAlignSide = 160, kExposeSide = 64;
// Exposures are fitted from kExposeFrom of the schedule on, because the brightness of what was trained
// briefly is off by as much as they differ. They are used if their exposure_change() is at least
// kMinExposure: where all exposures are equal it is .05 at most, for a metal.
constexpr double kExposeFrom = 0.3, kMinExposure = 0.08;
constexpr int kEvaluationBatches = 2;  // pixels of an evaluation, in batches of the training

class Training {
 public:
  Training(const RunContext& run, RunState& state)
      : run_(run),
        state_(state),
        judged_(run.views.held_out.pixels().empty() ? run.views.train : run.views.held_out),
        judged_name_(run.views.held_out.pixels().empty() ? "train" : "held-out"),
        begin_(run.progress.now() - state.training_seconds) {
    if (run.plan.geometry > 0) seconds_ = std::max(run.plan.geometry - state.start_seconds, 1.0);
    last_save_ = elapsed();
  }

  // Position in the schedule, in [0, 1).
  double position() const {
    return seconds_ > 0 ? elapsed() / seconds_ : double(state_.step) / run_.plan.iterations;
  }

  // One step, and what is due after it.
  void step(double u, const Stage::Checkpoint& checkpoint) {
    fit_views(u);
    const GeometryStats sum = state_.geometry->step(state_.step, u, {}, run_.progress);
    if (!std::isfinite(sum.color))
      fail("The training diverged at step {}: the loss is not a number.", state_.step);
    if (elapsed() > next_evaluation_) evaluate(u, sum);
    if (elapsed() > next_report_) report(u, sum);
    run_.live.offer([&](const Camera& camera) { return state_.geometry->render_radiance(camera, 1); });
    ++state_.step;
    if (elapsed() - last_save_ > kCheckpointSeconds) save(checkpoint);
  }

  void save(const Stage::Checkpoint& checkpoint) {
    state_.training_seconds = elapsed();
    checkpoint();
    last_save_ = elapsed();
  }

  double elapsed() const { return run_.progress.now() - begin_; }

 private:
  // Changes the state only when everything is computed: a run that is interrupted meanwhile resumes from
  // before.
  void fit_views(double u) {
    const auto due = int(std::count_if(kFits.begin(), kFits.end(), [&](const Fit& f) { return f.at <= u; }));
    if (state_.alignments >= due) return;
    PixelStore& pixels = run_.views.train;
    std::vector<Camera> cameras;
    std::vector<Vec3f> exposures;
    if (!state_.scene.refined.poses.empty()) cameras = aligned_cameras(u, kFits[size_t(due - 1)].align_share);
    if (run_.fit_exposures && u >= kExposeFrom && state_.step >= run_.preset.exposures_from_steps)
      exposures = found_exposures(u);
    if (!cameras.empty()) {
      pixels.set_cameras(std::move(cameras));
      keep_cameras(run_, state_);
    }
    if (!exposures.empty()) {
      pixels.set_exposures(std::move(exposures));
      keep_exposures(run_, state_);
    }
    state_.alignments = due;
  }

  // Of alignment. share: of the training that it may take. 0: it takes longer at any side.
  int align_side(double share) const {
    if (seconds_ == 0) return kAlignSides.front();
    if (align_rate_ == 0) return kFirstAlignSide;
    for (const int side : kAlignSides)
      if (align_rate_ * double(pixels_shown(run_.views.train, side)) <= share * seconds_) return side;
    return 0;
  }

  // A focal length that no trial has changed stays: here nothing tells whether a change pays. Empty: there is
  // no time.
  std::vector<Camera> aligned_cameras(double u, double share) {
    const PixelStore& pixels = run_.views.train;
    const int side = align_side(share);
    if (side == 0) return {};
    const double begin = elapsed();
    const double focal = state_.scene.refined.focal;
    const FocalPrior prior{focal != 1 ? run_.preset.trial.focal_error : 0, focal};
    AlignedViews aligned =
        align_views(show_views(*state_.geometry, pixels, side, run_.progress), pixels, prior);
    const double took = elapsed() - begin;
    align_rate_ = took / double(pixels_shown(pixels, side));
    run_.progress.log(Json{{"stage", "alignment"},
                           {"u", u},
                           {"side", side},
                           {"took", took},
                           {"pixels", aligned.pixels},
                           {"focal", focal * aligned.focal}}
                          .dump());
    return std::move(aligned.cameras);
  }

  // Empty: they are equal.
  std::vector<Vec3f> found_exposures(double u) {
    const PixelStore& pixels = run_.views.train;
    std::vector<Vec3f> found =
        find_exposures(show_views(*state_.geometry, pixels, kExposeSide, run_.progress), pixels);
    const double spread = exposure_change({}, found);
    run_.progress.log(Json{{"stage", "exposures"},
                           {"u", u},
                           {"spread", spread},
                           {"change", exposure_change(pixels.exposures(), found)}}
                          .dump());
    if (spread < kMinExposure && pixels.exposures().empty()) return {};
    return found;
  }

  void evaluate(double u, const GeometryStats& sum) {
    const double begin = elapsed(), rays = double(sum.rays);
    psnr_ = state_.geometry->evaluate(judged_, kEvaluationBatches * run_.preset.geometry.rays, u).psnr();
    const double end = elapsed();
    next_evaluation_ = end + std::max(kEvaluationSeconds, kEvaluationShare * (end - begin));
    run_.progress.log(Json{{"stage", "geometry"},
                           {"step", state_.step},
                           {"u", u},
                           {"color", sum.color / rays},
                           {"mask", sum.mask / rays},
                           {"eikonal", sum.eikonal / double(std::max<int64_t>(sum.kept, 1))},
                           {"psnr", psnr_},
                           {"on", judged_name_},
                           {"kept", double(sum.kept) / rays}}
                          .dump());
  }

  void report(double u, const GeometryStats& sum) {
    run_.progress.report({"", u, -1,
                          fmt::format("loss {:.4f}  {} {:.1f} dB at the object", sum.color / double(sum.rays),
                                      judged_name_, psnr_)});
    next_report_ = elapsed() + kReportSeconds;
  }

  const RunContext& run_;
  RunState& state_;
  const PixelStore& judged_;
  const char* judged_name_;
  double begin_;           // start of the training on the clock of the run, as if it had not been interrupted
  double seconds_ = 0;     // of the schedule; 0: by steps
  double align_rate_ = 0;  // s per pixel of the last alignment; 0: there was none yet
  // By elapsed().
  double next_evaluation_ = kEvaluationSeconds, next_report_ = kReportSeconds, last_save_ = 0;
  double psnr_ = 0;
};

// Sum of squared differences from the part of the photograph that begins at (column, row), over white,
// display-encoded.
double squared_error(const Image& rendered, const Image& photograph, int column, int row) {
  double sum = 0;
  for (int y = 0; y < rendered.height; ++y)
    for (int x = 0; x < rendered.width; ++x) {
      const float* want = photograph.at(column + x, row + y);
      for (int c = 0; c < 3; ++c) {
        const float over_white = srgb_from_linear(want[c]) * want[3] + 1 - want[3];
        sum += square(double(rendered.at(x, y)[c]) - over_white);
      }
    }
  return sum;
}

// The squared error of a view by the radiance field; nothing when is_over() before it is drawn.
template <class F>
std::optional<double> view_error(GeometryStage& stage, const Camera& whole, const Image& photograph,
                                 const F& is_over) {
  constexpr int kTile = 32;  // pixels an axis: with the largest networks a view takes minutes
  double error = 0;
  for (int row = 0; row < whole.height; row += kTile)
    for (int column = 0; column < whole.width; column += kTile) {
      if (is_over()) return std::nullopt;
      Camera tile = whole;
      tile.width = std::min(kTile, whole.width - column);
      tile.height = std::min(kTile, whole.height - row);
      tile.cx -= column;
      tile.cy -= row;
      error += squared_error(stage.render_radiance(tile, 2), photograph, column, row);
    }
  return error;
}

}  // namespace

void keep_cameras(const RunContext& run, RunState& state) {
  TrainingViews& views = run.views;
  state.scene.refined =
      refined_cameras(run.capture, views.given_train, views.train.cameras(), run.normalization);
  views.set_cameras(state.scene.refined, run.normalization);
}

void keep_exposures(const RunContext& run, RunState& state) {
  state.scene.exposures.clear();
  for (const View& v : run.capture.views)
    if (v.split == Split::train)
      state.scene.exposures.push_back({v.name, run.views.train.exposures()[state.scene.exposures.size()]});
}

void train_geometry(const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
  Training training(run, state);
  try {
    for (double u; (u = training.position()) < 1;) {
      check_cancelled(run.progress);
      training.step(u, checkpoint);
    }
  } catch (const Error& e) {  // a step that is interrupted has changed nothing: the state is that before it
    if (e.code() == ErrorCode::interrupted) training.save(checkpoint);
    throw;
  }
  state.training_seconds = training.elapsed();
}

void log_radiance_psnr(const RunContext& run, GeometryStage& stage, double focal) {
  constexpr size_t kViews = 8;
  constexpr double kSeconds = 15,
                   kReserveShare = 0.25;  // of a plan by time, whose other stages need the rest
  const double begin = run.progress.now(),
               seconds =
                   run.plan.geometry > 0 ? std::min(kSeconds, kReserveShare * run.plan.reserve) : kSeconds;
  const auto is_over = [&] { return run.progress.cancelled() || run.progress.now() - begin > seconds; };
  std::vector<const View*> held_out;
  for (const View& view : run.capture.views)
    if (view.split != Split::train) held_out.push_back(&view);
  double sum = 0;
  int views = 0;
  for (size_t i = 0; i < held_out.size(); ++i) {
    if (i > 0 && i * kViews / held_out.size() == (i - 1) * kViews / held_out.size()) continue;
    const Image photograph = run.images.load(*held_out[i]);
    const Camera whole = zoomed(run.normalization.unit_from_capture(held_out[i]->camera), focal);
    if (photograph.width != whole.width) return;  // downscaled
    const std::optional<double> error = view_error(stage, whole, photograph, is_over);
    if (!error) break;
    sum += psnr_of_mse(*error / (3.0 * whole.width * whole.height));
    ++views;
  }
  if (views)
    run.progress.log(
        Json{{"stage", "radiance field"}, {"held_out_psnr_on_white", sum / views}, {"views", views}}.dump());
}

}  // namespace cei3d

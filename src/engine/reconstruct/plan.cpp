// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/plan.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/scalar.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

// Costs of work that is not measured, in multiples of measured rates; from runs on spot, those of the start
// also on lego400.
constexpr double kMesh = 1.6;         // surface of an object over that of the sphere of Rates::mesh
constexpr double kGeometryStep = 13;  // a step of the geometry stage, in Rates::sdf_step
constexpr double kFirstLight = 4500;  // finding out how the light turns, in Rates::trial_step
// Finding it out on the trained surface, in Rates::hit_shaded: half as much where one material tells, and
// twice as much where the materials of the vertices must be searched.
constexpr double kLightMotion = 1.2e7;
constexpr double kStartShapes = 20000;  // that, start shapes and poses, in Rates::trial_step
constexpr double kStereo = 12000;       // the start shape by stereo, in Rates::trial_step
constexpr double kPolishStep = 68;      // a step of polishing, in Rates::sdf_step
// A pixel of the residual images, in times of tracing and shading a hit. A light that turns takes most.
constexpr double kResidualPixel = 3;
constexpr double kFullSplit = 2e7, kBriefSplit = 1.2e7;  // the linear separation, in Rates::hit_shaded
// Fit of lobes and descents, in Rates::albedo_step.
constexpr double kFullDescent = 7000, kBriefDescent = 750;
constexpr double kJointStep = 95;   // a step of the joint descent, in Rates::sdf_step
constexpr double kJointHits = 0.3;  // shading of the pixels that judge it, in those of the appearance stage
constexpr double kRefinementStep = 2;  // a step of a refinement, in Rates::albedo_step
constexpr double kReserve = 3;         // reading and writing files, in times of the first surface

// Minimum shares of all steps; fewer are not worth the time.
constexpr double kMinFirstPolish = 1.0 / 12, kMinSecondPolish = 1.0 / 6, kMinJointShare = 0.25,
                 kMinTrialShare = 0.4, kMinTrialShareCutOff = 0.75;
constexpr size_t kUntimedResidualPixels = 1000000;

// Of a run that is late: minimum shares of what was planned for the appearance stage's descent at full effort
// and for the residual images. A brief descent has no step to spare.
constexpr double kMinDescentShare = 0.4, kLeastResidual = 0.5;
constexpr double kWriting = 0.5;  // share of the reserve that is left for writing files

// The appearance stage sees Preset::max_hits of the training pixels, and each refinement of the albedo
// another subset. Refinements begin above the first ratio of pixels to max_hits, with one for each further
// multiple of the second.
constexpr double kSubsetsToRefine = 4, kSubsetsOfRefinement = 1.2;
// Refinements for which there may be time left, from this ratio on: in fewer pixels there are no others to
// see.
constexpr double kSubsetsToSpare = 2;
constexpr int kSpareRefinements = 4;

// Maximum shares of the whole time.
constexpr double kPolishShare = 0.1;        // a round's descent
constexpr double kPolishRoundsShare = 0.3;  // all rounds
constexpr double kFullEffortShare = 0.36;   // the appearance stage at full effort; else it is brief
constexpr double kLightMotionShare = 0.1;
constexpr double kRefinementsShare = 0.1;
constexpr double kJointShare = 0.1;
constexpr double kFinerMeshShare = 1.0 / 40;
constexpr double kCoupledShare = 0.3;   // of the network of a coupled color, in place of all that is left out
constexpr double kResidualShare = 0.1;  // residual images
// As shares of the geometry stage: comparison of start shapes; stereo alone; trials with aligned cameras,
// after the first.
constexpr double kTrialsShare = 0.3, kStereoShare = 0.4, kAlignmentShare = 0.1;

// Minimum shares of the whole time. Before the residual images comes light at all vertices, which grows with
// the object and not with its pixels.
constexpr double kReserveShare = 0.03, kMinResidualShare = 0.02, kMinGeometryShare = 0.35;

// Steps that the geometry stage gets before anything is polished or refined, unless they take more than a
// share of the whole time.
constexpr double kMinGeometrySteps = 4000, kMaxGeometryShare = 0.65;

// An object is cut off where more than this share of its masks reach the border of the image with that many
// pixels.
constexpr double kCutOff = 0.25;
constexpr size_t kMinAtBorder = 2;

// Costs are seconds.
struct TrialCosts {
  double step;     // of all trials
  double besides;  // start shapes and the first fits to them
};

struct Costs {
  double first_light;      // finding out how the light turns, without trials
  double light_motion;     // the same on the trained surface
  double geometry_step;    // one training step of the geometry stage
  TrialCosts trials;       // of the three start shapes
  TrialCosts hull_trials;  // of the hull alone, before and after its cameras are aligned
  double stereo;           // start shape by stereo alone
  double brief_surface;    // with brief_hits
  double full_descent, brief_descent;
  double surface, full_appearance, brief_appearance, refinement, finer_mesh;
  double look;    // of a polishing round
  double polish;  // all steps of a round
  double joint;   // all steps of it, hits and judgment
  double residual_pixel;
};

Costs costs_of(const Rates& r, const Preset& preset, size_t pixels) {
  const double hits = double(std::min(preset.max_hits, pixels)),
               brief_hits = double(std::min(preset.brief_hits, pixels)), hit = r.hit_traced + r.hit_shaded;
  const auto mesh = [&](const MeshingOptions& m) { return kMesh * r.mesh * square(double(m.resolution)); };
  const TrialOptions& trial = preset.trial;
  Costs c{};
  c.first_light = kFirstLight * r.trial_step;
  c.light_motion = kLightMotion * r.hit_shaded;
  c.geometry_step = kGeometryStep * r.sdf_step;
  const auto trials = [&](int count, double shapes) {
    return TrialCosts{r.trial_step * count * kGeometryStep,
                      r.trial_step * (count * trial.geometry.prefit_steps + shapes)};
  };
  c.trials = trials(3, kStartShapes);
  c.hull_trials = trials(2, kFirstLight);
  c.stereo = r.trial_step * (kFirstLight + kStereo);
  c.surface = mesh(preset.meshing) + hits * r.hit_traced;
  c.brief_surface = mesh(preset.meshing) + brief_hits * r.hit_traced;
  c.full_descent = kFullDescent * r.albedo_step;
  c.brief_descent = kBriefDescent * r.albedo_step;
  c.full_appearance = kFullSplit * r.hit_shaded + hits * hit + c.full_descent;
  c.brief_appearance = kBriefSplit * r.hit_shaded + brief_hits * hit + c.brief_descent;
  c.look = c.surface + c.brief_appearance;
  c.polish = preset.polish_steps * kPolishStep * r.sdf_step;
  c.refinement = hits * hit + kRefinementStep * preset.refinement_steps * r.albedo_step;
  c.joint = preset.joint_steps * kJointStep * r.sdf_step + c.surface + kJointHits * hits * hit;
  c.finer_mesh = mesh(preset.finer_meshing);
  c.residual_pixel = kResidualPixel * hit;
  return c;
}

bool has_finer_meshing(const Preset& preset) {
  return preset.finer_meshing.resolution > preset.meshing.resolution;
}

int iterations_of(const ReconstructOptions& options, const Preset& preset) {
  return options.iterations > 0 ? options.iterations : preset.iterations;
}

// The joint descent alone; t: 0: by steps.
Plan joint_plan(const ReconstructOptions& options, const Preset& preset, double t, const Costs& c) {
  Plan p;
  p.stages = StageChoice::joint;
  p.joint_steps = iterations_of(options, preset);
  p.has_finer_mesh = has_finer_meshing(preset) && c.finer_mesh <= kFinerMeshShare * t;
  p.finer_mesh = p.has_finer_mesh ? c.finer_mesh : 0;
  p.reserve = std::min(std::max(kReserve * c.brief_surface, kReserveShare * t), (1 - kMinGeometryShare) * t);
  p.joint = t - p.reserve - p.finer_mesh;
  return p;
}

Plan untimed_plan(const ReconstructOptions& options, const Preset& preset) {
  Plan p;
  p.iterations = iterations_of(options, preset);
  const bool tries = preset.start == StartChoice::trials && p.iterations >= preset.trials_from_iterations;
  p.trial_steps = tries ? preset.trial.steps : 0;
  p.polish_rounds = p.iterations >= preset.polish_from_iterations ? 2 : 0;
  p.polish_steps = preset.polish_steps / 2;
  p.joint_steps = p.polish_rounds > 0 ? preset.joint_steps / 2 : 0;
  p.has_finer_mesh = has_finer_meshing(preset) && p.polish_rounds > 0;
  p.residual_pixels = std::min(preset.max_residual_pixels, kUntimedResidualPixels);
  return p;
}

void plan_polish(double t, const Preset& preset, const Costs& c, Plan& p) {
  p.look = c.look;
  p.polish_steps = preset.polish_steps;
  const auto seconds = [&](int rounds) {  // of a descent
    return std::min({c.polish, kPolishShare * t, kPolishRoundsShare * t / rounds - c.look});
  };
  p.polish_rounds = seconds(2) >= kMinSecondPolish * c.polish  ? 2
                    : seconds(1) >= kMinFirstPolish * c.polish ? 1
                                                               : 0;
  if (p.polish_rounds > 0) p.polish = seconds(p.polish_rounds);
}

void set_effort(Effort effort, const Costs& c, Plan& p) {
  p.effort = effort;
  p.appearance = effort == Effort::full ? c.full_appearance : c.brief_appearance;
  p.descent = effort == Effort::full ? c.full_descent : c.brief_descent;
}

void plan_appearance(double t, const Preset& preset, const Costs& c, size_t pixels, Plan& p) {
  set_effort(c.full_appearance <= kFullEffortShare * t ? Effort::full : Effort::brief, c, p);
  p.refinement = c.refinement;
  const double subsets = double(pixels) / double(preset.max_hits),
               wanted = (subsets - kSubsetsToRefine) / kSubsetsOfRefinement,
               affordable = kRefinementsShare * t / c.refinement;
  p.refinements = std::max(0, int(std::min(wanted, affordable)));
  p.spare_refinements = subsets >= kSubsetsToSpare ? kSpareRefinements : 0;
}

// wanted: by the user, however few steps there is time for.
void plan_joint(double t, const Costs& c, const Preset& preset, bool wanted, Plan& p) {
  if (preset.joint_steps <= 0 || (!wanted && kJointShare * t < kMinJointShare * c.joint)) return;
  p.joint_steps = preset.joint_steps;
  p.joint = std::min(c.joint, kJointShare * t);
}

void plan_residual(double t, const Costs& c, const Preset& preset, size_t pixels, Plan& p) {
  p.residual_pixels =
      std::min({preset.max_residual_pixels, pixels, size_t(kResidualShare * t / c.residual_pixel)});
  if (p.residual_pixels > 0)
    p.residual = std::max(kMinResidualShare * t, c.residual_pixel * double(p.residual_pixels));
}

// Seconds of all but the geometry stage.
double rest_of(const Plan& p) {
  return p.light_motion + p.polish_rounds * (p.polish + p.look) + p.appearance +
         p.refinements * p.refinement + p.joint + p.finer_mesh + p.residual + p.reserve;
}

// Removes the least valuable stage; false: nothing is left to remove.
bool leave_one_out(const Costs& c, Plan& p) {
  if (p.joint_steps > 0) {
    p.joint_steps = 0;
    p.joint = 0;
  } else if (p.refinements > 0) {
    --p.refinements;
  } else if (p.polish_rounds > 0) {
    --p.polish_rounds;
  } else if (p.has_finer_mesh) {
    p.has_finer_mesh = false;
    p.finer_mesh = 0;
  } else if (p.residual_pixels > 0) {
    p.residual_pixels = 0;
    p.residual = 0;
  } else if (p.effort == Effort::full) {
    set_effort(Effort::brief, c, p);
  } else {
    return false;
  }
  return true;
}

// 0: fewer than the minimum share of the wanted ones. seconds: of the geometry stage.
int affordable_trial_steps(double seconds, int wanted, double min_share, const TrialCosts& c) {
  const double steps = std::min((kTrialsShare * seconds - c.besides) / c.step, double(wanted));
  return steps >= min_share * wanted ? int(steps) : 0;
}

// Where the visual hull is far from the object, so is what is trained from it briefly, and cameras that are
// aligned with that are moved away from where they are (docs/notebook/0047). refine_poses: whether the user
// wants that.
void plan_start(const Preset& preset, const PlannedPixels& pixels, const Costs& c, bool refine_poses,
                Plan& p) {
  if (preset.start != StartChoice::trials) return;
  const double min_share = pixels.cut_off ? kMinTrialShareCutOff : kMinTrialShare;
  p.trial_steps = affordable_trial_steps(p.geometry, preset.trial.steps, min_share, c.trials);
  if (p.trial_steps == 0 && refine_poses && !pixels.cut_off) {
    p.trial_steps = affordable_trial_steps(p.geometry, preset.trial.steps, min_share, c.hull_trials);
    p.hull_alone = p.trial_steps > 0;
  }
  p.alignment = kAlignmentShare * p.geometry;
  const bool stereo = p.trial_steps == 0 && pixels.cut_off && c.stereo <= kStereoShare * p.geometry;
  p.start = stereo ? Start::stereo : Start::hull;
}

Plan timed_plan(double t, const Preset& preset, const PlannedPixels& pixels, const Costs& c,
                const ReconstructOptions& wanted) {
  Plan p;
  plan_polish(t, preset, c, p);
  plan_appearance(t, preset, c, pixels.count, p);
  plan_joint(t, c, preset, wanted.joint_steps > 0, p);
  plan_residual(t, c, preset, pixels.count, p);
  p.has_finer_mesh = has_finer_meshing(preset) && c.finer_mesh <= kFinerMeshShare * t;
  p.finer_mesh = p.has_finer_mesh ? c.finer_mesh : 0;
  p.reserve = std::max(kReserve * c.surface, kReserveShare * t);
  const double enough = std::clamp(c.first_light + kMinGeometrySteps * c.geometry_step, kMinGeometryShare * t,
                                   kMaxGeometryShare * t);
  const auto refines = [&] { return p.polish_rounds + p.refinements + p.joint_steps > 0; };
  while (rest_of(p) > t - enough && refines()) leave_one_out(c, p);
  while (rest_of(p) > (1 - kMinGeometryShare) * t && leave_one_out(c, p)) continue;
  if (p.polish_rounds == 0 && !wanted.light) p.light_motion = std::min(c.light_motion, kLightMotionShare * t);
  p.geometry = std::max(kMinGeometryShare * t, t - rest_of(p));
  plan_start(preset, pixels, c, wanted.refine_poses, p);
  return p;
}

// A plan without light and material; t: 0: by steps.
Plan without_light(Plan p, double t, const Preset& preset, const PlannedPixels& pixels, const Costs& c,
                   const ReconstructOptions& wanted) {
  p.color = ColorChoice::coupled;
  p.polish_rounds = p.refinements = p.spare_refinements = p.joint_steps = 0;
  p.light_motion = p.look = p.polish = p.appearance = p.descent = p.refinement = p.joint = 0;
  p.residual_pixels = 0;
  p.residual_steps =
      std::max(1, t > 0 ? preset.residual_steps : std::min(preset.residual_steps, p.iterations) / 2);
  p.residual_hits = std::min(preset.max_residual_hits, t > 0 ? pixels.count : kUntimedResidualPixels);
  if (t <= 0) return p;
  p.has_finer_mesh = has_finer_meshing(preset) && c.finer_mesh <= kFinerMeshShare * t;
  p.finer_mesh = p.has_finer_mesh ? c.finer_mesh : 0;
  p.residual = kCoupledShare * t;
  p.reserve = std::min(p.reserve, (1 - kMinGeometryShare - kCoupledShare - kFinerMeshShare) * t);
  p.geometry = t - rest_of(p);
  plan_start(preset, pixels, c, wanted.refine_poses, p);
  return p;
}

}  // namespace

PlannedPixels planned_pixels(const PixelStore& pixels) {
  size_t cut_off = 0;
  for (size_t v = 0; v < pixels.masks().size(); ++v) {
    const size_t w = size_t(pixels.cameras()[v].width), h = size_t(pixels.cameras()[v].height);
    const auto& mask = pixels.masks()[v];
    size_t at_border = 0;
    for (size_t x = 0; x < w; ++x) at_border += (mask[x] == kObject) + (mask[(h - 1) * w + x] == kObject);
    for (size_t y = 0; y < h; ++y) at_border += (mask[y * w] == kObject) + (mask[y * w + w - 1] == kObject);
    cut_off += at_border >= kMinAtBorder;
  }
  return {pixels.pixels().size(), double(cut_off) > kCutOff * double(pixels.masks().size())};
}

Plan plan_of(const ReconstructOptions& options, const Preset& given, const PlannedPixels& pixels,
             const Rates& rates) {
  Preset preset = given;
  if (options.joint_steps >= 0) preset.joint_steps = options.joint_steps;
  const bool timed = options.seconds > 0 && options.iterations <= 0;
  const Costs costs = timed ? costs_of(rates, preset, pixels.count) : Costs{};
  const double t = timed ? options.seconds : 0;
  const bool coupled = preset.color == ColorChoice::coupled;
  if (coupled && preset.stages == StageChoice::joint)
    fail_usage("A coupled color has no light to descend on; it goes with the setting stages=all.");
  if (preset.stages == StageChoice::joint) return joint_plan(options, preset, t, costs);
  const Plan plan = timed ? timed_plan(t, preset, pixels, costs, options) : untimed_plan(options, preset);
  return coupled ? without_light(plan, t, preset, pixels, costs, options) : plan;
}

double affordable_descent(const Plan& p, double left) {
  if (p.descent <= 0 || p.effort == Effort::brief) return 1;
  const double later = p.finer_mesh + kLeastResidual * p.residual + kWriting * p.reserve;
  return std::clamp((left - later) / p.descent, kMinDescentShare, 1.0);
}

bool has_time_for_finer_mesh(const Plan& p, double left) {
  return left >= p.finer_mesh + kLeastResidual * p.residual;
}

double seconds_of_residual(const Plan& p, double left) {
  return std::max(left - kWriting * p.reserve, kLeastResidual * p.residual);
}

Json to_json(const Plan& p) {
  return {{"trial_steps", p.trial_steps},
          {"hull_alone", p.hull_alone},
          {"alignment", p.alignment},
          {"start", p.start == Start::stereo ? "stereo" : "hull"},
          {"geometry", p.geometry},
          {"iterations", p.iterations},
          {"light_motion", p.light_motion},
          {"polish_rounds", p.polish_rounds},
          {"look", p.look},
          {"polish", p.polish},
          {"effort", p.effort == Effort::full ? "full" : "brief"},
          {"appearance", p.appearance},
          {"descent", p.descent},
          {"refinements", p.refinements},
          {"spare_refinements", p.spare_refinements},
          {"refinement", p.refinement},
          {"joint_steps", p.joint_steps},
          {"joint", p.joint},
          {"finer_mesh", p.finer_mesh},
          {"residual_pixels", p.residual_pixels},
          {"residual_hits", p.residual_hits},
          {"residual", p.residual},
          {"reserve", p.reserve}};
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// A run that is interrupted anywhere and resumed makes the same object, bit for bit.
#include "engine/reconstruct/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/json.h"
#include "core/base/test_unknown_keys.h"
#include "engine/reconstruct/run_state.h"
#include "engine/reconstruct/test_run.h"

namespace cei3d {
namespace {

using How = ScriptedProgress::How;

// A run by steps that has every stage such a run can have.
class AnyRun {
 public:
  AnyRun(const Capture& capture, const ImageSource& images)
      : preset(shrunken(preset_by_name("fast"))), capture_(capture), images_(images) {
    preset.polish_from_iterations = preset.trials_from_iterations = 1;
    options.iterations = 24;
    options.seed = 5;
  }
  Scene run(Checkpoints& checkpoints, Progress& progress, ShowPicture show = {}, Clock clock = {}) {
    VirtualClock time(tick);
    return reconstruct({.device = device_,
                        .capture = capture_,
                        .images = images_,
                        .normalization = {},
                        .options = options,
                        .preset = preset,
                        .clock = clock ? std::move(clock) : time.clock(),
                        .show = std::move(show)},
                       checkpoints, progress);
  }

  Preset preset;
  ReconstructOptions options;
  double tick = 0.7;  // s of the virtual clock; so that the geometry stage saves in its middle

 private:
  Device device_ = make_device();
  const Capture& capture_;
  const ImageSource& images_;
};

template <class C>
struct Owner {
  C own;
};

// A run on an object of one material under a light that stands still.
class SmallRun : Owner<BoxCapture>, public AnyRun {
 public:
  SmallRun() : AnyRun(own.capture(), own) {}
};

// Under a light that turns: so small a run cannot find out that it does.
class SmallTurningRun : Owner<TurntableCapture>, public AnyRun {
 public:
  SmallTurningRun() : AnyRun(own.capture(), own) { options.light = LightMotion::turntable; }
};

class SmallExposedRun : Owner<ExposedCapture>, public AnyRun {
 public:
  SmallExposedRun() : AnyRun(own.capture(), own) { preset.exposures_from_steps = 1; }
};

// Of everything together, from a sphere.
class SmallJointRun : Owner<BoxCapture>, public AnyRun {
 public:
  SmallJointRun() : AnyRun(own.capture(), own) { preset.stages = StageChoice::joint; }
};

class SmallPaperRun : Owner<BoxCapture>, public AnyRun {
 public:
  SmallPaperRun() : AnyRun(own.capture(), own) { preset = shrunken(preset_by_name("paper")); }
};

// Of the field and of a network of colors over position and direction.
class SmallCoupledRun : Owner<BoxCapture>, public AnyRun {
 public:
  SmallCoupledRun() : AnyRun(own.capture(), own) { preset.color = ColorChoice::coupled; }
};

class SmallRunFromASphere : Owner<BoxCapture>, public AnyRun {
 public:
  SmallRunFromASphere() : AnyRun(own.capture(), own) { preset.start = StartChoice::sphere; }
};

Checkpoints::State saved(const Scene& scene) {
  Checkpoints::State s;
  save_scene(scene, s.tensors, s.head);
  return s;
}

// What an uninterrupted run leaves.
struct Reference {
  explicit Reference(AnyRun& small) : scene(saved(small.run(checkpoints, progress))) {}
  MemoryCheckpoints checkpoints;
  ScriptedProgress progress;
  Checkpoints::State scene;
};

const Reference& uninterrupted() {
  static SmallRun small;
  static const Reference reference(small);
  return reference;
}

// Runs up to the check, or to the end; the stage's name must be in the message.
void run_interrupted(AnyRun& small, MemoryCheckpoints& checkpoints, const std::string& stage, int check,
                     How how) {
  ScriptedProgress progress;
  progress.stop_at(stage, check, how);
  try {
    small.run(checkpoints, progress);
    ADD_FAILURE() << "not stopped in " << stage << " at check " << check;
  } catch (const Killed&) {
    EXPECT_EQ(how, How::kill);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::interrupted) << e.what();
    EXPECT_NE(std::string(e.what()).find(stage), std::string::npos) << e.what();
    EXPECT_EQ(e.hint().empty(), !checkpoints.latest_state) << e.what();  // the hint tells how to resume
  }
}

// Interrupts the stage, resumes it, and compares what is saved after it (or the object, after the last one).
void expect_same_after(AnyRun& small, const Reference& reference, size_t stage, int check, How how) {
  const std::vector<std::string>& stages = reference.progress.stages;
  const std::string &name = stages[stage], where = name + " at check " + std::to_string(check) +
                                                   (how == How::kill ? ", killed" : "");
  MemoryCheckpoints checkpoints;
  if (stage > 1) checkpoints.latest_state = reference.checkpoints.after.at(stages[stage - 1]);
  run_interrupted(small, checkpoints, name, check, how);
  if (stage + 2 < stages.size()) {
    run_interrupted(small, checkpoints, stages[stage + 1], 1, How::cancel);
    ASSERT_TRUE(checkpoints.after.contains(name)) << where;
    expect_same(checkpoints.after.at(name).tensors, reference.checkpoints.after.at(name).tensors, where);
    EXPECT_EQ(checkpoints.after.at(name).head.at("state").at("scene"),
              reference.checkpoints.after.at(name).head.at("state").at("scene"));
  } else {
    ScriptedProgress rest;
    expect_same(saved(small.run(checkpoints, rest)).tensors, reference.scene.tensors, where);
  }
}

TEST(Reconstruct, IsSeenWhileItIsMadeAndIsTheSame) {
  SmallRun small;
  MemoryCheckpoints checkpoints;
  ScriptedProgress progress;
  std::map<std::string, Image> pictures;  // the last of each stage
  const auto show = [&](const Image& p) { pictures[progress.stages.back()] = p; };
  const Clock clock = [&] { return 4.0 * progress.all_checks(); };  // time for a picture after every step
  expect_same(saved(small.run(checkpoints, progress, show, clock)).tensors, uninterrupted().scene.tensors,
              "while somebody looks");
  for (const char* stage : {"geometry", "polish 1", "polish 2", "appearance", "joint"})
    EXPECT_TRUE(pictures.contains(stage)) << stage;
  for (const auto& [stage, p] : pictures) {
    SCOPED_TRACE(stage);
    EXPECT_LE(std::max(p.width, p.height), 160);
    EXPECT_NEAR(p.at(0, 0)[0], 1, 0.1f);  // the corner shows the white ground
    const bool seen =
        std::any_of(p.data.begin(), p.data.end(), [](float x) { return std::abs(x - 1) > 0.1f; });
    EXPECT_TRUE(seen);  // the object: darker, or, before its albedo is learned, brighter
  }
}

TEST(Reconstruct, ResumedAnywhereMakesTheSameObject) {
  SmallRun small;
  const Reference& reference = uninterrupted();
  const std::vector<std::string>& stages = reference.progress.stages;
  const std::vector<std::string> expected{"loading",  "start",      "geometry", "polish 1",
                                          "polish 2", "surface",    "light",    "appearance",
                                          "joint",    "finer mesh", "residual", "done"};
  ASSERT_EQ(stages, expected);
  EXPECT_GT(reference.checkpoints.midway.at("geometry"), 0);
  for (size_t s = 1; s + 1 < stages.size(); ++s) {
    const int checks = reference.progress.checks.at(stages[s]);
    ASSERT_GE(checks, 3) << stages[s];
    expect_same_after(small, reference, s, checks / 2 + 1, How::kill);
    expect_same_after(small, reference, s, checks, How::cancel);
  }
  expect_same_after(small, reference, 2, reference.progress.checks.at("geometry") / 2, How::cancel);
}

// The line that says whether the joint stage's result was kept; how good it is, is in it to the last bit.
Json joint_judgment(const ScriptedProgress& progress) {
  const auto line = std::find_if(progress.lines.begin(), progress.lines.end(), [](const Json& l) {
    return l.contains("kept") && l.value("stage", "") == "joint";
  });
  return line == progress.lines.end() ? Json() : *line;
}

// A run that was killed as soon as the stage had saved its descent `saves` times, each before a step.
MemoryCheckpoints killed_in_the_middle(AnyRun& small, const Checkpoints::State& from,
                                       const std::string& stage, int saves) {
  KilledAfterSaves killed(from, stage, saves);
  ScriptedProgress progress;
  EXPECT_THROW(small.run(killed, progress), Killed);
  EXPECT_FALSE(killed.latest_state->head.at("finished").get<bool>());
  EXPECT_EQ(killed.latest_state->head.at("state").at("descent_step"), saves - 1);
  MemoryCheckpoints left;
  left.latest_state = killed.latest_state;
  return left;
}

TEST(Reconstruct, TheJointStageIsResumedInTheMiddleOfItsDescent) {
  SmallRun small;
  small.tick = 40;  // every step is saved
  const Reference& reference = uninterrupted();
  const Json judgment = joint_judgment(reference.progress);
  ASSERT_TRUE(judgment.contains("after"));
  for (const int saves : {1, 2, 3, 4}) {  // before the first step and after it, a refresh before the last
    SCOPED_TRACE(saves);
    MemoryCheckpoints resumed =
        killed_in_the_middle(small, reference.checkpoints.after.at("appearance"), "joint", saves);
    ScriptedProgress rest;
    const Scene scene = small.run(resumed, rest);
    EXPECT_EQ(joint_judgment(rest), judgment);
    expect_same(saved(scene).tensors, reference.scene.tensors, "the object");
  }
}

TEST(Reconstruct, ARoundOfPolishingIsResumedInTheMiddleOfItsDescent) {
  SmallRun small;
  small.tick = 40;  // every step is saved
  const Reference& reference = uninterrupted();
  for (const int saves : {1, 3}) {  // before the first step, and between others
    SCOPED_TRACE(saves);
    MemoryCheckpoints resumed =
        killed_in_the_middle(small, reference.checkpoints.after.at("polish 1"), "polish 2", saves);
    run_interrupted(small, resumed, "surface", 1, How::cancel);
    expect_same(resumed.after.at("polish 2").tensors, reference.checkpoints.after.at("polish 2").tensors,
                "after the round");
  }
}

TEST(Reconstruct, InterruptedAgainAndAgainMakesTheSameObject) {
  SmallRun small;
  const Reference& reference = uninterrupted();
  MemoryCheckpoints checkpoints;
  const std::vector<std::string>& stages = reference.progress.stages;
  for (size_t s = 1; s + 1 < stages.size(); ++s)
    run_interrupted(small, checkpoints, stages[s], 2, s % 2 ? How::kill : How::cancel);
  ScriptedProgress rest;
  const Checkpoints::State scene = saved(small.run(checkpoints, rest));
  expect_same(scene.tensors, reference.scene.tensors, "the object");
  EXPECT_EQ(scene.head, reference.scene.head);
}

// Interrupts each stage from `first` on, at three quarters of its checks, and resumes it.
Checkpoints::State with_interruptions(AnyRun& small, MemoryCheckpoints& checkpoints,
                                      const ScriptedProgress& uninterrupted, size_t first) {
  const std::vector<std::string>& stages = uninterrupted.stages;
  for (size_t s = first; s + 1 < stages.size(); ++s)
    run_interrupted(small, checkpoints, stages[s], uninterrupted.checks.at(stages[s]) * 3 / 4,
                    s % 2 ? How::cancel : How::kill);
  ScriptedProgress rest;
  return saved(small.run(checkpoints, rest));
}

// The state after the stage, with a network of materials, as an object of several has one.
Checkpoints::State with_materials(const Checkpoints::State& state, const FieldConfig& network) {
  SavedRun run = read_checkpoint(state, {});
  run.state.scene.material = {run.state.scene.material.mean(), std::make_shared<Field>(network, 9)};
  return checkpoint_of(run.position, run.state);
}

TEST(Reconstruct, ACheckpointKeepsTheShareOfTheDescentThatThereIsTimeFor) {
  SavedRun run = read_checkpoint(uninterrupted().checkpoints.after.at("light"), {});
  EXPECT_EQ(run.state.descent_share, 1);
  run.state.descent_share = 0.625;
  EXPECT_EQ(read_checkpoint(checkpoint_of(run.position, run.state), {}).state.descent_share, 0.625);
}

TEST(Reconstruct, ATurningLightAndSeveralMaterialsAreResumedAnywhere) {
  SmallTurningRun small;
  const Reference turning(small);
  ASSERT_EQ(turning.scene.head.at("light_frame").at("motion"), "turntable");
  MemoryCheckpoints again;
  const Checkpoints::State object = with_interruptions(small, again, turning.progress, 1);
  expect_same(object.tensors, turning.scene.tensors, "turning light");
  EXPECT_EQ(object.head, turning.scene.head);

  MemoryCheckpoints of_several;
  of_several.latest_state =
      with_materials(turning.checkpoints.after.at("light"), small.preset.appearance.materials);
  MemoryCheckpoints interrupted = of_several;
  ScriptedProgress progress;
  const Checkpoints::State several = saved(small.run(of_several, progress));
  ASSERT_TRUE(several.head.contains("materials"));
  const Checkpoints::State same = with_interruptions(small, interrupted, progress, 1);
  expect_same(same.tensors, several.tensors, "several materials");
  EXPECT_EQ(same.head, several.head);
}

TEST(Reconstruct, ExposuresAreFittedKeptAndResumed) {
  SmallExposedRun small;
  const Reference reference(small);
  ASSERT_EQ(reference.scene.head.at("exposures").size(), 10u);  // of the training views
  const int checks = reference.progress.checks.at("geometry");
  for (const int check : {checks / 2, checks * 5 / 8, checks * 3 / 4, checks * 7 / 8, checks}) {
    expect_same_after(small, reference, 2, check, How::kill);
    expect_same_after(small, reference, 2, check, How::cancel);
  }
  SmallExposedRun given;
  given.options.fit_exposures = false;
  MemoryCheckpoints checkpoints;
  ScriptedProgress progress;
  EXPECT_TRUE(given.run(checkpoints, progress).exposures.empty());
}

// A run whose geometry stage does not look for exposures. With so few photographs and steps it finds about
// half of what they differ by.
TEST(Reconstruct, PolishingFindsTheBrightnessOfPhotographs) {
  const ExposedCapture box(12, 64);
  AnyRun run(box.capture(), box);
  run.preset.exposures_from_steps = 1000000;
  run.preset.max_hits = 20000;
  const Reference reference(run);
  EXPECT_FALSE(reference.scene.head.contains("exposures"));
  const Tensors& polished = reference.checkpoints.after.at("polish 2").tensors;
  ASSERT_TRUE(polished.contains("brightness"));
  const std::vector<float> found = polished.at("brightness").f32;
  double bright = 0, dark = 0;  // logarithms
  size_t i = 0;
  for (const View& view : box.capture().views) {
    if (view.split != Split::train) continue;
    (ExposedCapture::factor(view.name) > 1 ? bright : dark) += std::log(found.at(i++)) / 5;
  }
  EXPECT_EQ(i, found.size());
  EXPECT_GT(bright - dark, 0.4 * std::log(1.3 / 0.6));
  EXPECT_LT(bright - dark, 1.1 * std::log(1.3 / 0.6));
  const auto& stages = reference.progress.stages;
  const auto light = size_t(std::find(stages.begin(), stages.end(), "light") - stages.begin());
  expect_same_after(run, reference, light, 1, How::kill);
}

// A run of the joint descent alone.
void expect_resumed_anywhere(AnyRun& small, const std::vector<std::string>& expected) {
  const Reference reference(small);
  ASSERT_EQ(reference.progress.stages, expected);
  MemoryCheckpoints again;
  const Checkpoints::State object = with_interruptions(small, again, reference.progress, 1);
  expect_same(object.tensors, reference.scene.tensors, "the object");
  EXPECT_EQ(object.head, reference.scene.head);
  const int checks = reference.progress.checks.at("joint");
  for (const int check : {checks / 3, checks / 2, checks * 5 / 6}) {
    expect_same_after(small, reference, 1, check, How::kill);
    expect_same_after(small, reference, 1, check, How::cancel);
  }
}

TEST(Reconstruct, TheJointDescentAloneIsResumedAnywhere) {
  SmallJointRun small;
  expect_resumed_anywhere(small, {"loading", "joint", "surface", "finer mesh", "done"});
}

TEST(Reconstruct, ThePapersRunIsResumedAnywhere) {
  SmallPaperRun small;
  expect_resumed_anywhere(small, {"loading", "joint", "surface", "done"});
}

TEST(Reconstruct, CoupledColorIsResumedAnywhere) {
  SmallCoupledRun small;
  const Reference reference(small);
  EXPECT_EQ(reference.progress.checks.count("color"), 1u);
  MemoryCheckpoints again;
  const Checkpoints::State object = with_interruptions(small, again, reference.progress, 1);
  expect_same(object.tensors, reference.scene.tensors, "the object");
  EXPECT_EQ(object.head, reference.scene.head);
}

TEST(Reconstruct, FromASphereIsResumedAnywhere) {
  SmallRunFromASphere small;
  const Reference reference(small);
  MemoryCheckpoints again;
  const Checkpoints::State object = with_interruptions(small, again, reference.progress, 1);
  expect_same(object.tensors, reference.scene.tensors, "the object");
  const std::string weight = "sdf/layer0/weight";
  EXPECT_NE(object.tensors.at(weight).f32,
            uninterrupted().scene.tensors.at(weight).f32);  // from another shape
}

// Before there were stages, checkpoints held the geometry stage alone.
TEST(Reconstruct, ResumesACheckpointOfTheFirstVersion) {
  SmallRun small;
  small.options.refine_poses = false;  // there were no refined poses either
  const Reference reference(small);
  MemoryCheckpoints checkpoints;
  run_interrupted(small, checkpoints, "geometry", 12, How::cancel);
  const Json state = checkpoints.latest_state->head.at("state");
  Tensors geometry;
  for (const auto& [name, tensor] : checkpoints.latest_state->tensors)
    if (name.starts_with("geometry/")) geometry[name.substr(9)] = tensor;
  checkpoints.latest_state = Checkpoints::State{Json::object({{"stage", "geometry"},
                                                              {"step", state.at("step")},
                                                              {"elapsed", state.at("training_seconds")},
                                                              {"start", 1.5}}),
                                                geometry};
  ScriptedProgress rest;
  expect_same(saved(small.run(checkpoints, rest)).tensors, reference.scene.tensors, "the object");
}

TEST(Reconstruct, RefusesACheckpointItCannotResume) {
  SmallRun small;
  ScriptedProgress progress;
  MemoryCheckpoints checkpoints;
  run_interrupted(small, checkpoints, "geometry", 3, How::cancel);
  const Checkpoints::State good = *checkpoints.latest_state;
  const auto sentence = [&](const Json& change) {
    checkpoints.latest_state = good;
    checkpoints.latest_state->head.update(change);
    try {
      small.run(checkpoints, progress);
    } catch (const Error& e) {
      EXPECT_NE(e.hint().find("anew"), std::string::npos) << e.what();
      return std::string(e.what());
    }
    return std::string("it was resumed");
  };
  EXPECT_NE(sentence(Json::object({{"stage", "sculpting"}})).find("'sculpting'"), std::string::npos);
  EXPECT_NE(sentence(Json::object({{"version", 99}})).find("newer program"), std::string::npos);
  EXPECT_NE(sentence(Json::object({{"state", Json::object()}})).find("lacks the key 'step'"),
            std::string::npos);
  EXPECT_NE(sentence(Json::object({{"state", "gone"}})).find("damaged"), std::string::npos);
}

TEST(Reconstruct, RefusesUnknownKeysInACheckpoint) {
  SmallRun small;
  const Checkpoints::State good = uninterrupted().checkpoints.after.at("appearance");
  const auto read = [&](const Json& bad) {
    MemoryCheckpoints checkpoints;
    checkpoints.latest_state = Checkpoints::State{bad, good.tensors};
    ScriptedProgress progress;
    progress.stop_at("joint", 1);  // where it would resume
    small.run(checkpoints, progress);
  };
  EXPECT_EQ(objects_with_unknown_keys_read(good.head, "checkpoint", read), std::vector<std::string>());
}

}  // namespace
}  // namespace cei3d

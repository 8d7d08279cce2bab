// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluation.h"

#include <functional>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/base/time_left.h"
#include "engine/evaluate/evaluation_objects.h"
#include "engine/session/stopwatch.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kInterrupted =
    "The evaluation was interrupted. Finished rows are kept; run the same command again to continue.";

// Progress within a row, under the row's name and clock.
class RowProgress : public Progress {
 public:
  RowProgress(Progress& whole, std::string name) : whole_(whole), name_(std::move(name)) {
    whole_.report({name_, 0, -1, ""});
  }

 private:
  void on_report(const ProgressReport& r) override {
    elapsed_ += watch_.lap();
    const double by_progress = time_left_.after(r.fraction, elapsed_);
    const double left = r.seconds_left < 0 ? by_progress : r.seconds_left;
    whole_.report({name_, r.fraction, left, r.stage + (r.message.empty() ? "" : ", " + r.message)});
  }
  void on_log(const std::string& line) override { whole_.log(line); }
  bool is_cancelled() const override { return whole_.cancelled(); }

  Progress& whole_;
  std::string name_;
  Stopwatch watch_;
  double elapsed_ = 0;  // seconds
  TimeLeft time_left_;
};

double total_seconds(const EditSummary& s) {
  double sum = s.load_seconds + s.store_seconds;
  for (const auto& [stage, seconds] : s.report.at("seconds").items()) sum += seconds.get<double>();
  return sum;
}

class Job {
 public:
  Job(Session& session, const EvaluationRequest& request, Progress& progress)
      : session_(session),
        r_(request),
        progress_(progress),
        rows_(request.out / "rows"),
        objects_(session, request) {
    report_.capture = full_path(r_.capture);
    report_.folder = r_.out;
  }

  EvaluationReport run() {
    report_.object = object_row();
    save();
    constexpr auto kBase = PaintTarget::albedo;
    if (r_.paint) add(report_.paint, paint_row("paint", "the method", kBase, Routing::both));
    if (r_.paint && r_.ablations) {
      const auto ablation = [&](const char* name, const char* what, PaintTarget target, Routing routing) {
        add(report_.paint, paint_row(name, what, target, routing));
      };
      ablation("paint-points", "handler points without the scribble's outline", kBase, Routing::points);
      ablation("paint-outline", "the scribble's outline without handler points", kBase, Routing::outline);
      ablation("paint-none", "no handler points: the albedo field is retrained", kBase, Routing::none);
      ablation("paint-radiance", "RGB in place of disentangled properties", PaintTarget::radiance,
               Routing::both);
    }
    if (r_.part) {
      add(report_.part, part_row("part", "the method", false));
      add(report_.part, part_row("part-in-view", "no propagation: what the clicked view shows", true));
    }
    if (r_.applications) add_applications();
    for (const int n : r_.views) add(report_.views, views_row(n));
    for (const int n : r_.downscales) add(report_.sizes, size_row(n));
    return report_;
  }

 private:
  using Object = EvaluationObject;
  Object whole() const { return objects_.whole(); }

  void add(std::vector<EvaluationRow>& rows, EvaluationRow row) {
    rows.push_back(std::move(row));
    save();
  }
  void save() const {
    write_file_atomic(r_.out / "report.json", report_.json().dump(1) + "\n");
    write_file_atomic(r_.out / "report.md", report_.markdown());
  }

  // The stored row, or a new one.
  EvaluationRow row(const std::string& name, const std::string& what, const Json& settings,
                    const std::function<void(EvaluationRow&, Progress&)>& work) {
    check_cancelled(progress_, kInterrupted);
    if (const Json kept = rows_.find(name, settings); !kept.is_null())
      return evaluation_row_from_json(kept, (r_.out / "rows" / (name + ".json")).string());
    EvaluationRow row;
    row.name = name;
    row.what = what;
    try {
      RowProgress progress(progress_, name);
      work(row, progress);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::interrupted) throw Error(ErrorCode::interrupted, kInterrupted);
      throw;
    }
    rows_.put(name, settings, row.json());
    return row;
  }

  Json eval_settings(const Object& o) const {
    return {{"object", objects_.settings(o)},
            {"samples", r_.samples},
            {"lpips", full_path(r_.networks.lpips)},
            {"fid", full_path(r_.networks.fid)}};
  }
  Json paint_settings(const Object& o) const {
    Json j = eval_settings(o);
    if (r_.paint)
      j["paint"] = {{"view", r_.paint->view},
                    {"scribble", content_hash(r_.paint->scribble.read())},
                    {"truth", full_path(r_.paint_truth.pictures)},
                    {"masks", full_path(r_.paint_truth.masks)}};
    return j;
  }

  EvalRequest eval_request(const std::string& name) const {
    EvalRequest e;
    e.samples = r_.samples;
    e.networks = r_.networks;
    e.pictures = r_.out / "pictures" / name;
    return e;
  }

  void score_edit(const EditSummary& edit, const EditTruth& truth, EvaluationRow& row, Progress& progress) {
    EvalRequest e = eval_request(row.name);
    e.edit = edit.id;
    e.truth = truth.pictures;
    e.masks = truth.masks;
    row.details = edit.json();
    row.scores = session_.evaluate(e, progress);
    session_.undo(progress);
  }

  EditSummary paint(PaintTarget target, Routing routing, Progress& progress) {
    PaintCommand command;
    command.strokes = {*r_.paint};
    command.target = target;
    command.routing = routing;
    return session_.paint(command, progress);
  }

  EvaluationRow object_row() {
    return row("object", "all views, full size", eval_settings(whole()),
               [&](EvaluationRow& row, Progress& p) {
                 row.seconds = objects_.open(whole(), p);
                 const ProjectInfo info = session_.info();
                 row.details = info.json();
                 row.details["found"] = info.object.text();
                 row.scores = session_.evaluate(eval_request(row.name), p);
               });
  }

  EvaluationRow paint_row(const char* name, const char* what, PaintTarget target, Routing routing) {
    return row(name, what, paint_settings(whole()), [&](EvaluationRow& row, Progress& p) {
      objects_.open(whole(), p);
      const EditSummary edit = paint(target, routing, p);
      row.seconds = total_seconds(edit);
      score_edit(edit, r_.paint_truth, row, p);
    });
  }

  EvaluationRow part_row(const char* name, const char* what, bool in_view) {
    PartCommand command = r_.part->command;
    command.in_view = in_view;
    Json settings = eval_settings(whole());
    settings["part"] = {{"view", command.view},
                        {"color", command.effects.color},
                        {"clicks", Json::array()},
                        {"truth", full_path(r_.part->truth.pictures)},
                        {"masks", full_path(r_.part->truth.masks)}};
    for (const auto* clicks : {&command.positive, &command.negative})
      for (const auto& c : *clicks)
        settings["part"]["clicks"].push_back({clicks == &command.positive, c.x, c.y});
    return row(name, what, settings, [&](EvaluationRow& row, Progress& p) {
      objects_.open(whole(), p);
      const EditSummary edit = session_.select_part(command, p);
      row.seconds = total_seconds(edit);
      score_edit(edit, r_.part->truth, row, p);
    });
  }

  // What cannot be done to this object is skipped.
  EvaluationRow application_row(const char* name, const char* what,
                                const std::function<EditSummary(Progress&)>& edit) {
    Json settings = eval_settings(whole());
    settings["application"] = what;
    try {
      return row(name, what, settings, [&](EvaluationRow& row, Progress& p) {
        objects_.open(whole(), p);
        const EditSummary made = edit(p);
        row.seconds = total_seconds(made);
        score_edit(made, {}, row, p);
      });
    } catch (const Error& e) {
      if (e.code() == ErrorCode::interrupted) throw;
      return {name, what, e.what(), 0, {}, {}};
    }
  }

  void add_applications() {
    add(report_.applications,
        application_row("roughness", "a glossy object made rough, or the reverse", [&](Progress& p) {
          MaterialCommand c;
          c.effects.roughness = session_.info().object.mean.roughness < 0.35f ? 0.6 : 0.15;
          return session_.change_material(c, p);
        }));
    add(report_.applications, application_row("light", "the light turned by 90 degrees", [&](Progress& p) {
          LightChoice turned;
          turned.rotate_degrees = 90;
          return session_.change_light(turned, p);
        }));
    add(report_.applications,
        application_row("drag", "the middle of a view dragged by an eighth of its width",
                        [&](Progress& p) { return session_.deform(drag(), p); }));
  }

  // In the middle of the object as the painted, or else the first, view shows it.
  DeformCommand drag() const {
    const Capture& capture = objects_.capture();
    const View& view = r_.paint ? find_view(capture, r_.paint->view) : capture.views.front();
    const Vec3d middle = view.camera.project(session_.info().normalization.center);
    return {PixelDrag{view.name, {middle.x, middle.y}, {0.125 * view.camera.width, 0}}, {}, ""};
  }

  EvaluationRow views_row(int n) {
    const std::string name = fmt::format("views-{}", n), what = fmt::format("{} views", n);
    if (n > objects_.training_views())
      return {name, what, fmt::format("the capture has {} training views", objects_.training_views()),
              0,    {},   {}};
    ReconstructOptions o = trial_options();
    o.views = n == objects_.training_views() ? 0 : n;
    return trial_row(name, what, o);
  }

  EvaluationRow size_row(int n) {
    ReconstructOptions o = trial_options();
    o.downscale = n;
    return trial_row(fmt::format("size-{}", n), n == 1 ? "full size" : fmt::format("1/{} of the size", n), o);
  }

  ReconstructOptions trial_options() const {
    ReconstructOptions o = r_.options;
    if (r_.trial_seconds > 0) o.seconds = r_.trial_seconds;
    return o;
  }

  EvaluationRow trial_row(const std::string& name, const std::string& what,
                          const ReconstructOptions& options) {
    const Object object = objects_.with(options);
    try {
      return row(name, what, paint_settings(object), [&](EvaluationRow& row, Progress& p) {
        row.seconds = objects_.open(object, p);
        if (r_.paint) return score_edit(paint(PaintTarget::albedo, Routing::both, p), r_.paint_truth, row, p);
        row.scores = session_.evaluate(eval_request(row.name), p);
      });
    } catch (const Error& e) {  // too few or too small photographs; go on with the other rows
      if (e.code() != ErrorCode::failed) throw;
      return {name, what, e.what(), 0, {}, {}};
    }
  }

  Session& session_;
  const EvaluationRequest& r_;
  Progress& progress_;
  KeptValues rows_;
  EvaluationObjects objects_;
  EvaluationReport report_;
};

}  // namespace

EvaluationReport evaluate_capture(Session& session, const EvaluationRequest& request, Progress& progress) {
  return session.threads().run([&] { return Job(session, request, progress).run(); });
}

}  // namespace cei3d

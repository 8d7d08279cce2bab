// SPDX-License-Identifier: Apache-2.0
// What is open: a folder, a capture, a project; and what the page is told of it.
#include "apps/server/edit_json.h"
#include "apps/server/editor.h"
#include "apps/server/guarded.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "engine/capture/normalize.h"
#include "engine/io/png_file.h"
#include "engine/project/lock.h"
#include "engine/project/project.h"
#include "engine/segment/sam.h"
#include "engine/session/version.h"
#include "model/geometry/shape/camera_json.h"
#include "model/geometry/shape/vec_json.h"
#include "model/material/presets.h"
#include "model/scene/scene.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// An edit as the history of the page shows it: without cameras, and with the number of strokes instead of the
// strokes.
Json entry_json(const LogEntry& e) {
  Json j = e.json();
  if (j["params"].contains("strokes")) {
    j["strokes"] = j["params"]["strokes"].size();
    j["params"].erase("strokes");
  }
  j["params"].erase("camera");
  return j;
}

Json views_json(const std::vector<View>& views) {
  Json list = Json::array();
  std::error_code error;
  for (const View& v : views)
    list.push_back({{"name", v.name},
                    {"split", split_name(v.split)},
                    {"photo", fs::is_regular_file(v.image_path, error)},
                    {"camera", camera_json(v.camera)}});
  return list;
}

Json presets_json() {
  Json list = Json::array();
  for (const MaterialPreset& p : material_presets()) list.push_back(std::string(p.name));
  return list;
}

// What does not change while a project is open.
Json object_json(const Session& session, const ProjectInfo& info) {
  const Scene scene = session.scene();
  const NamedCamera start = session.start_camera();
  return {{"views", views_json(session.views())},
          {"start", {{"view", start.name}, {"camera", camera_json(start.camera)}}},
          {"center", vector_json(info.normalization.center)},
          {"radius", kObjectRadius / info.normalization.scale},
          {"up", vector_json(normalize(scene.up))},
          {"material", info.object.json()},
          {"summary", info.object.text()},
          {"warning", info.object.warning()},
          {"presets", presets_json()},
          {"segment", fs::exists(installed_sam() / "encoder.onnx")}};
}

}  // namespace

void Editor::open_path(Session& session, const fs::path& path) {
  {
    const std::lock_guard lock(mutex_);
    previews_.clear();
  }
  if (!home_.empty()) options_.project.clear();  // it was given for the capture that was open before
  worker_->drop_frames();                        // of the object that was open before
  release_packs();
  if (!Project::is_project(path)) return open_capture(session, path);
  open_project(session, path);
}

void Editor::open_project(Session& session, const fs::path& path) {
  const std::string note = open_for_access(session, path);
  const ProjectInfo info = session.info();
  if (info.finished)
    show_object(session, path, info, note);
  else
    show_unfinished(session, path, info);
}

std::string Editor::open_for_access(Session& session, const fs::path& path) {
  read_only_ = options_.read_only;
  try {
    session.open(path, read_only_ ? Session::Access::read : Session::Access::write);
    return "";
  } catch (const InUseError&) {
    session.open(path, Session::Access::read);
    read_only_ = true;
    return "Another cei3d is changing this object, so it is open read-only.";
  }
}

// Like its capture, from which the page can resume the reconstruction.
void Editor::show_unfinished(Session& session, const fs::path& path, const ProjectInfo& info) {
  session.close();
  capture_ = info.capture_root;
  options_.project = path;
  publish(Json{{"mode", "capture"},
               {"name", path.filename().string()},
               {"resume", true},
               {"project", path.string()},
               {"can_close", !home_.empty()},
               {"program", kVersion}});
}

void Editor::show_object(Session& session, const fs::path& path, const ProjectInfo& info,
                         const std::string& note) {
  const Json object = object_json(session, info);
  {
    const std::lock_guard lock(mutex_);
    object_ = object;
    exports_.clear();
    exports_folder_ = path / "exports";
    state_ = {{"mode", "project"},
              {"name", entry_at(path)->name},
              {"folder", fs::absolute(path).lexically_normal().string()},
              {"read_only", read_only_.load()},
              {"note", note},
              {"can_close", !home_.empty()},
              {"program", kVersion}};
  }
  {
    const bool quick = session.frame_is_quick();
    const std::lock_guard lock(mutex_);
    first_frame_ = quick;
  }
  publish(session);
  prepare_packs();
}

fs::path Editor::object_folder() const {
  if (!options_.project.empty()) return options_.project;
  std::error_code error;
  fs::path folder = fs::absolute(capture_).lexically_normal();
  if (!folder.has_filename() || fs::is_regular_file(folder, error)) folder = folder.parent_path();
  return (home_.empty() ? folder.parent_path() : home_) / (folder.filename().string() + "-object");
}

void Editor::open_capture(Session& session, const fs::path& path) {
  session.close();
  capture_ = path;
  if (Project::is_project(object_folder())) return open_project(session, object_folder());
  publish(Json{{"mode", "checking"}, {"name", entry_at(path)->name}, {"can_close", !home_.empty()}});
  const CheckReport checked = session.check({path, CheckRequest().options, {}});
  publish(Json{{"mode", "capture"},
               {"name", entry_at(path)->name},
               {"check", checked.json()},
               {"project", object_folder().string()},
               {"resume", false},
               {"can_close", !home_.empty()},
               {"program", kVersion}});
}

void Editor::show_library() {
  worker_->drop_frames();
  Json entries = Json::array();
  for (const LibraryEntry& e : entries_below(home_)) entries.push_back(e.json());
  publish(Json{{"mode", "library"},
               {"name", fs::weakly_canonical(home_).filename().string()},
               {"folder", fs::absolute(home_).lexically_normal().string()},
               {"entries", entries},
               {"formats", capture_format_layouts("\n")},
               {"sample", sample_capture().has_value()},
               {"program", kVersion}});
}

void Editor::publish(Session& session) {
  Json state = this->state();
  Json grows = {{"history", Json::array()}, {"parts", Json::array()}};
  size_t done = 0;
  for (const LogEntry& e : session.log()) {
    grows["history"].push_back(entry_json(e));
    done += e.done && !e.set_aside;
  }
  for (const PartInfo& p : session.parts()) grows["parts"].push_back(p.json());
  state["revision"] = content_hash(grows["history"].dump()).substr(0, 12);
  state["done"] = done;
  state["packs"] = session.view_keys();
  publish(std::move(state), std::move(grows));
}

void Editor::publish(Json state, Json grows) {
  grows.update(state);
  std::string text = text_of(grows);
  {
    const std::lock_guard lock(mutex_);
    state_ = state;
    state_text_ = std::move(text);
  }
  broadcast({{"type", "state"}, {"mode", state["mode"]}, {"revision", state.value("revision", "")}});
}

void Editor::show_making(const Image& picture) {
  std::string png = encode_png(picture, 8);
  {
    const std::lock_guard lock(mutex_);
    making_ = std::move(png);
  }
  broadcast({{"type", "making"}});
}

void Editor::reconstruct(JsonReader& j, const HttpRequest&, Reply reply) {
  constexpr double kMin = 20, kMax = 7 * 24 * 3600;
  ReconstructRequest request;
  request.resume = j.optional("resume", false);
  request.options.seconds = j.optional("seconds", 300.0);
  j.finish();
  if (!(request.options.seconds >= kMin && request.options.seconds <= kMax))
    fail_usage("A reconstruction takes {} seconds to {} days.", kMin, int(kMax / 86400));
  if (options_.read_only) fail_usage("This folder is open read-only.");
  on_worker("reconstruct", std::move(reply), [this, request](Session& session, Progress& progress) mutable {
    if (state().value("mode", "") != "capture") fail_usage("There is no capture open to make an object of.");
    if (!request.resume) request.capture = capture_;
    request.project = object_folder();
    request.show = [this](const Image& picture) { show_making(picture); };
    Json now = state();
    now["mode"] = "reconstructing";
    publish(now);
    {
      const std::lock_guard lock(mutex_);
      making_.clear();
    }
    try {
      session.reconstruct(request, progress);
    } catch (const Error&) {
      session.close();
      now["mode"] = "capture";
      now["resume"] = Project::is_project(request.project);
      publish(now);
      throw;
    }
    open_project(session, request.project);
    return HttpResponse{200, "application/json", state_text()};
  });
}

}  // namespace cei3d

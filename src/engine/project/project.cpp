// SPDX-License-Identifier: Apache-2.0
#include "engine/project/project.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/base/rollback.h"
#include "core/base/system.h"
#include "engine/project/dataset.h"
#include "engine/project/json_file.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFormat = "cei3d-project";
constexpr size_t kCheckpointsKept = 2;

Json head_json(const ProjectHead& head) {
  const Normalization& n = head.normalization;
  return {{"format", kFormat},
          {"version", kProjectVersion},
          {"created", utc_text("%Y-%m-%dT%H:%M:%SZ")},
          {"normalization", {{"center", {n.center.x, n.center.y, n.center.z}}, {"scale", n.scale}}},
          {"options", head.options}};
}

void check_version(const Json& j, const fs::path& path) {
  if (!j.is_object() || j.value("format", Json()) != kFormat)
    fail("{} is not a cei3d project file.", path.string());
  const int version = j.at("version").get<int>();
  if (version > kProjectVersion)
    fail(
        "{} was written by a newer program (format {}; this one reads up to {}); update cei3d. Nothing was "
        "changed.",
        path.string(), version, kProjectVersion);
  if (version < 1) fail("{} has the invalid format version {}.", path.string(), version);
}

ProjectHead read_head(const fs::path& path) {
  return read_json_file(path, [&](const Json& j) {
    check_version(j, path);
    ProjectHead head;
    JsonReader reader(j, path.string());
    for (const char* key : {"format", "version", "created"}) reader.has(key);
    JsonReader n = reader.object("normalization");
    head.normalization = {vector_from(n, "center"), n.require<double>("scale")};
    n.finish();
    head.options = reader.member("options");
    reader.finish();
    return head;
  });
}

bool is_empty_or_missing(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return true;
  if (!fs::is_directory(folder, error)) return false;
  return fs::is_empty(folder, error);
}

bool is_temporary(const fs::path& file) {
  return file.filename().string().find(".tmp-") != std::string::npos;
}

std::vector<fs::path> children(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    found.push_back(it->path());
  std::sort(found.begin(), found.end());
  return found;
}

void remove_temporaries(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& p : children(folder))
    if (is_temporary(p)) fs::remove(p, error);
}

// Makes the folder of a new project. The returned guard removes it and the project's first files.
Rollback make_folder(const fs::path& folder) {
  std::error_code error;
  const bool existed = fs::exists(folder, error);
  fs::create_directories(folder, error);
  if (error) fail("Cannot make folder {}: {}.", folder.string(), error.message());
  return Rollback([folder, existed] {
    std::error_code ignored;
    for (const char* name : {"project.json", "dataset.json", "stack.json", ".lock"})
      fs::remove(folder / name, ignored);
    if (!existed) fs::remove(folder, ignored);
  });
}

}  // namespace

bool Project::is_project(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "project.json", error);
}

void Project::check_place(const fs::path& folder, bool replace) {
  if (is_project(folder)) {
    if (!replace)
      fail_usage("{} is a project already; resume it, replace it by force, or choose another folder.",
                 folder.string());
    check_version(parse_json_file(folder / "project.json"), folder / "project.json");
    return;
  }
  if (!is_empty_or_missing(folder))
    fail_usage("{} exists and is not a project; name a new or empty folder.", folder.string());
}

void Project::discard_if_empty() {
  require_writable();
  if (has_base() || !checkpoint_files().empty()) return;
  std::error_code error;
  // project.json first: a half-removed folder is then not a project.
  for (const char* name : {"project.json", "dataset.json", "stack.json", "history.jsonl", "base", "objects",
                           "runs", "doubtful", ".lock"})
    fs::remove_all(file(name), error);
  fs::remove(folder_, error);
}

Project::Project(fs::path folder, Mode mode)
    : folder_(std::move(folder)),
      lock_(mode == Mode::write ? ProjectLock(folder_) : ProjectLock()),
      head_(read_head(file("project.json"))),
      stack_(Stack::from_json(parse_json_file(file("stack.json")), file("stack.json").string())),
      store_(folder_ / "objects") {
  Dataset dataset =
      read_json_file(file("dataset.json"), [&](const Json& j) { return dataset_from_json(j, folder_); });
  given_capture_ = capture_ = std::move(dataset.capture);
  fingerprint_ = std::move(dataset.fingerprint);
  capture_ = with_cameras(given_capture_, refined_cameras());
}

Project Project::create(const fs::path& folder, const ProjectHead& head, const Capture& capture,
                        bool replace) {
  check_place(folder, replace);
  if (is_project(folder)) {
    const ProjectLock lock(folder);
    // base/ first: so that the old object is never shown with the new cameras.
    for (const char* name : {"base", "stack.json", "edits", "objects", "cache", "runs", "doubtful"})
      fs::remove_all(folder / name);
    write_json_file(folder / "stack.json", Stack().to_json());
    write_json_file(folder / "dataset.json", dataset_json(capture, folder));
    write_json_file(folder / "project.json", head_json(head));
  } else {
    Rollback guard = make_folder(folder);
    write_json_file(folder / "stack.json", Stack().to_json());
    write_json_file(folder / "dataset.json", dataset_json(capture, folder));
    write_json_file(folder / "project.json", head_json(head));  // last: it makes the folder a project
    guard.keep();
  }
  return open(folder, Mode::write);
}

Project Project::open(const fs::path& folder, Mode mode) {
  std::error_code error;
  if (!fs::exists(folder, error))
    fail("There is no project {}; make one with `cei3d reconstruct CAPTURE -o {}`.", folder.string(),
         folder.string());
  if (!is_project(folder)) fail("{} is not a project: it has no project.json.", folder.string());
  read_head(folder / "project.json");  // a newer format is found before the lock file is touched
  return Project(folder, mode);
}

void Project::require_writable() const {
  if (!lock_.held()) fail("Project {} was opened for reading only.", folder_.string());
}

std::vector<fs::path> Project::checkpoint_files() const {
  std::vector<fs::path> files;
  for (const fs::path& p : children(file("base")))
    if (p.filename().string().ends_with(".ckpt.json")) files.push_back(p);
  std::reverse(files.begin(), files.end());
  return files;
}

void Project::save_checkpoint(const TrainingState& state) {
  require_writable();
  std::vector<fs::path> files = checkpoint_files();
  const int number = files.empty() ? 1 : std::atoi(files.front().filename().c_str()) + 1;
  const std::string name = fmt::format("{:06}.ckpt.json", number);
  const std::string object = store_.put(state.tensors);
  write_json_file(file("base") / name, {{"head", state.head}, {"object", object}});
  write_file_atomic(file("base") / "latest", name + "\n");
  std::error_code error;
  for (size_t i = kCheckpointsKept - 1; i < files.size(); ++i) fs::remove(files[i], error);
  collect_garbage();
}

std::optional<TrainingState> Project::latest_checkpoint() const {
  const std::vector<fs::path> files = checkpoint_files();
  for (size_t i = 0; i < files.size(); ++i) {
    try {
      return read_json_file(files[i], [&](const Json& j) {
        JsonReader reader(j, files[i].string());
        const Json& head = reader.member("head");
        const auto object = reader.require<std::string>("object");
        reader.finish();
        return TrainingState{head, store_.get(object)};
      });
    } catch (const Error&) {
      if (i + 1 == files.size()) throw;  // an older one is better than none
    }
  }
  return std::nullopt;
}

void Project::save_base(const Scene& scene) {
  require_writable();
  Tensors tensors;
  Json head = Json::object();
  save_scene(scene, tensors, head);
  const std::string object = store_.put(tensors);
  write_json_file(file("base/scene.json"), {{"object", object}, {"head", std::move(head)}});
  capture_ = with_cameras(given_capture_, scene.refined);
  collect_garbage();
}

bool Project::has_base() const {
  std::error_code error;
  return fs::exists(file("base/scene.json"), error);
}

RefinedCameras Project::refined_cameras() const {
  if (!has_base()) return {};
  return read_json_file(file("base/scene.json"), [&](const Json& j) {
    return refined_from_head(j.at("head"), file("base/scene.json").string());
  });
}

std::string Project::base_key() const {
  return has_base() ? content_hash(read_file(file("base/scene.json"))) : "";
}

Scene Project::base() const {
  if (!has_base()) fail("Project {} holds no finished object; resume its reconstruction.", folder_.string());
  return read_json_file(file("base/scene.json"), [&](const Json& j) {
    JsonReader reader(j, file("base/scene.json").string());
    const auto object = reader.require<std::string>("object");
    const Json& head = reader.member("head");
    reader.finish();
    const std::string key = content_hash(object + head.dump());
    if (key != loaded_key_)
      loaded_base_ = load_scene(store_.get(object), head, "The object in " + reader.what());
    loaded_key_ = key;
    return loaded_base_;
  });
}

void Project::save_stack(const Stack& stack) {
  write_json_file(file("stack.json"), stack.to_json());
  stack_ = stack;
}

void Project::add_history(Json event) {
  require_writable();
  Json line = {{"time", utc_text("%Y-%m-%dT%H:%M:%SZ")}};
  line.update(event);
  append_to_file(file("history.jsonl"), line.dump() + "\n");
}

fs::path Project::new_run(const std::string& verb) {
  require_writable();
  const std::string stem = utc_text("%Y%m%d-%H%M%S") + "-" + verb;
  fs::path folder = file("runs") / stem;
  for (int i = 2; fs::exists(folder); ++i) folder = file("runs") / fmt::format("{}-{}", stem, i);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail("Cannot make folder {}: {}.", folder.string(), error.message());
  return folder;
}

void Project::share_layer_memory(size_t used) {
  layers_->limit(kMaxLayerBytes - std::min(used, kMaxLayerBytes - kMinLayerBytes));
}

void Project::collect_garbage() {
  std::set<std::string> keep;
  const auto note = [&](const Json& j) { keep.insert(j.at("object").get<std::string>()); };
  try {
    for (const fs::path& p : checkpoint_files()) read_json_file(p, note);
    if (has_base()) read_json_file(file("base/scene.json"), note);
    for (const std::string& id : stack_.all_ids())
      for (const std::string& object : edit_objects(id)) keep.insert(object);
  } catch (const Error&) {
    return;  // an unreadable file might name any object: nothing is removed
  }
  std::error_code error;
  for (const fs::path& p : children(file("edits")))
    if (!stack_.contains(p.filename().string()) && fs::exists(p / "edit.json", error))
      fs::remove_all(p, error);
  remove_temporaries(folder_);
  remove_temporaries(file("base"));
  store_.remove_all_but(keep, [this](const std::string& object) { layers_->keep(object); });
}

}  // namespace cei3d

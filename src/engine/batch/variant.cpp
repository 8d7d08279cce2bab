// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/variant.h"

#include "core/base/error.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

bool is_replay(const Json& edit) { return edit.at("edit") == "replay"; }

fs::path replayed_project(const Json& edit, const BatchVariant& v) {
  JsonReader r(edit, fmt::format("An edit of variant '{}'", v.name));
  r.has("edit");
  const fs::path project = r.require<std::string>("project");
  r.finish();
  return project;
}

// Tensors are never written again under the same name, so that the copy may share them.
void copy_project(const fs::path& from, const fs::path& to) {
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    const fs::path target = to / fs::relative(entry.path(), from);
    const bool shared = target.extension() == ".safetensors";
    if (entry.is_directory()) fs::create_directories(target);
    if (!entry.is_regular_file() || entry.path().filename() == ".lock") continue;
    if (shared) fs::create_hard_link(entry.path(), target, error);
    if (!shared || error) fs::copy_file(entry.path(), target);
  }
}

}  // namespace

Json variant_inputs(const BatchVariant& v, Session& session) {
  Json out = Json::array();
  for (const Json& edit : v.edits) {
    out.push_back(edit);
    if (!is_replay(edit)) continue;
    session.open(replayed_project(edit, v), Session::Access::read);
    for (const LogEntry& e : session.log()) out.push_back({e.id, e.op, e.done, e.enabled, e.params});
    session.close();
  }
  return out;
}

Json make_variant(const BatchVariant& v, const fs::path& project, const fs::path& out, Session& session,
                  Progress& progress) {
  fs::remove_all(out);
  fs::create_directories(out);
  copy_project(project, out);
  Json ids = Json::array();
  for (const Json& edit : v.edits) {
    if (is_replay(edit)) {
      session.open(replayed_project(edit, v), Session::Access::read);
      for (const auto& [from, to] : session.replay(out, progress).edits) ids.push_back(to);
      session.close();
      continue;
    }
    Json params = edit;
    params.erase("edit");
    session.open(out, Session::Access::write);
    ids.push_back(session.edit_by_params(edit.at("edit").get<std::string>(), params, progress).id);
    session.close();
  }
  return {{"edits", ids}};
}

}  // namespace cei3d

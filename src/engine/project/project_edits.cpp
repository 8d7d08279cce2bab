// SPDX-License-Identifier: Apache-2.0
// The edits of a project: records, results, and the scene made of them.
#include <algorithm>
#include <optional>

#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/base/system.h"
#include "engine/project/json_file.h"
#include "engine/project/project.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Removes the files of an edit unless keep() was called.
class EditGuard {
 public:
  explicit EditGuard(fs::path folder) : folder_(std::move(folder)) {}
  ~EditGuard() {
    std::error_code error;
    if (!kept_) fs::remove_all(folder_, error);
  }
  EditGuard(const EditGuard&) = delete;
  EditGuard& operator=(const EditGuard&) = delete;
  void keep() { kept_ = true; }

 private:
  fs::path folder_;
  bool kept_ = false;
};

std::string object_of(const Json& j) { return j.at("object").get<std::string>(); }

constexpr const char* kAnyKey = "";  // key of the only result of an edit in format 1

}  // namespace

// A stored result of an edit.
struct Project::StoredResult {
  std::string file;    // that names it
  std::string key;     // hash of what it depends on
  std::string object;  // its tensors
  Json head;
  Aspects changes;

  bool fits(const std::string& k) const { return key == kAnyKey || key == k; }
  std::string fingerprint() const { return content_hash(object + head.dump()); }
};

// Results of the active edits, in order, up to the first that must be remade.
struct Project::Resolved {
  std::vector<StoredResult> results;
  std::string stale, stale_key;  // of that edit; empty: there is none
};

std::vector<Project::StoredResult> Project::results_of(const std::string& id) const {
  return read_json_file(edit_file(id), [&](const Json& j) {
    const std::string file = edit_file(id).string();
    std::vector<StoredResult> results;
    const auto add = [&](const std::string& key, const Json& r, std::optional<Aspects> changes) {
      JsonReader result(r, "A result in " + file);
      results.push_back({file, key, result.require<std::string>("object"), result.member("head"),
                         changes ? *changes : aspects_from_json(result.array("changes"))});
      result.finish();
    };
    if (j.contains("result"))
      add(kAnyKey, j.at("result"), Aspects{.look = true});
    else
      for (const auto& [key, r] : j.at("results").items()) add(key, r, std::nullopt);
    return results;
  });
}

std::vector<std::string> Project::edit_objects(const std::string& id) const {
  std::vector<std::string> objects;
  for (const StoredResult& r : results_of(id)) objects.push_back(r.object);
  return objects;
}

std::string Project::result_key(Aspects depends, const std::vector<StoredResult>& before) const {
  std::string parts = read_json_file(file("base/scene.json"), object_of);
  for (const StoredResult& r : before)
    if (meet(r.changes, depends)) parts += r.fingerprint();
  return content_hash(parts);
}

Aspects Project::depends_of(const std::string& id) const {
  return read_json_file(edit_file(id), [](const Json& j) {
    return j.contains("depends") ? aspects_from_json(j.at("depends")) : Aspects{};
  });
}

Project::Resolved Project::resolve(const Stack& stack) const {
  Resolved out;
  for (const std::string& id : stack.active()) {
    const std::string key = result_key(depends_of(id), out.results);
    std::vector<StoredResult> all = results_of(id);
    const auto it = std::find_if(all.begin(), all.end(), [&](const StoredResult& r) { return r.fits(key); });
    if (it == all.end()) {
      out.stale = id;
      out.stale_key = key;
      break;
    }
    out.results.push_back(std::move(*it));
  }
  return out;
}

EditLayer Project::load_result(const StoredResult& r) const {
  EditLayer layer = load_layer(store_.get(r.object), r.head, "A result in " + r.file);
  layer.content = r.fingerprint();
  return layer;
}

Scene Project::with_results(const Scene& base, std::span<const StoredResult> results) const {
  std::vector<std::string> keys;
  for (const StoredResult& r : results) keys.push_back(r.fingerprint());
  return scenes_.scene(loaded_key_, base, keys, [&](size_t i) { return load_result(results[i]); });
}

Scene Project::scene() const {
  const Scene base = this->base();
  const Resolved resolved = resolve(stack_);
  if (!resolved.stale.empty())
    fail(
        "Edit {} must be remade for the present object, which only a command that writes can do: switch it "
        "off and on again with `cei3d toggle`.",
        resolved.stale);
  return with_results(base, resolved.results);
}

std::optional<std::string> Project::first_stale(const Stack& stack) const {
  const std::string id = resolve(stack).stale;
  return id.empty() ? std::nullopt : std::optional(id);
}

Scene Project::scene_below(const Stack& stack, const std::string& id) const {
  const Resolved resolved = resolve(stack);
  const std::vector<std::string> active = stack.active();
  const auto end = std::find(active.begin(), active.end(), id) - active.begin();
  return with_results(base(),
                      std::span(resolved.results).first(std::min(resolved.results.size(), size_t(end))));
}

Json Project::store_result(const std::string& key, const EditLayer& layer) {
  Tensors tensors;
  Json head = Json::object();
  save_layer(layer, tensors, head);
  return {{key,
           {{"object", store_.put(tensors)},
            {"head", std::move(head)},
            {"changes", to_json(changed_by(layer))}}}};
}

void Project::add_result(const Stack& stack, const std::string& id, const EditLayer& layer, int op_version) {
  require_writable();
  const Resolved resolved = resolve(stack);
  if (resolved.stale != id || layer.id != id)
    fail("Edit '{}' is out of order (an error in the program).", id);
  Json j = parse_json_file(edit_file(id));
  j.at("results").update(store_result(resolved.stale_key, layer));
  if (const int first = j.at("op_version").get<int>(); first != op_version)
    j.at("report")["note"] =
        fmt::format("remade by version {} of the operation, first made by version {}", op_version, first);
  write_json_file(edit_file(id), j);
}

void Project::add_edit(const EditRecord& record, const EditLayer& layer, Place place) {
  require_writable();
  if (record.id != stack_.next_id(record.op) || layer.id != record.id)
    fail("Edit '{}' is out of order (an error in the program).", record.id);
  Stack below = stack_, next = stack_;
  if (place == Place::instead_of_last) below.undo();
  place == Place::on_top ? next.push(record.id) : next.amend(record.id);
  const fs::path folder = file("edits") / record.id;
  EditGuard guard(folder);
  Json inputs = Json::object();
  for (const auto& [name, bytes] : record.inputs) {
    write_file_atomic(folder / name, bytes);
    inputs[name] = content_hash(bytes);
  }
  write_json_file(edit_file(record.id),
                  {{"id", record.id},
                   {"op", record.op},
                   {"op_version", record.op_version},
                   {"time", utc_text("%Y-%m-%dT%H:%M:%SZ")},
                   {"params", record.params},
                   {"inputs", std::move(inputs)},
                   {"depends", to_json(record.depends)},
                   {"report", record.report},
                   {"results", store_result(result_key(record.depends, resolve(below).results), layer)}});
  save_stack(next);
  guard.keep();
  collect_garbage();
  add_history({{"do", record.op}, {"id", record.id}, {"params", record.params}});
}

EditRecord Project::edit(const std::string& id) const {
  if (!stack_.contains(id))
    fail_usage("Project {} has no edit '{}'; `cei3d log` lists them.", folder_.string(), id);
  const Aspects depends = depends_of(id);
  return read_json_file(edit_file(id), [&](const Json& j) {
    EditRecord r;
    JsonReader reader(j, edit_file(id).string());
    r.depends = depends;
    r.id = reader.require<std::string>("id");
    r.op = reader.require<std::string>("op");
    r.op_version = reader.require<int>("op_version");
    r.params = reader.member("params");
    r.report = reader.member("report");
    // Read elsewhere; "result" is from format 1.
    for (const char* key : {"time", "inputs", "depends", "result", "results"}) reader.has(key);
    reader.finish();
    return r;
  });
}

std::vector<std::pair<std::string, std::string>> Project::edit_inputs(const std::string& id) const {
  return read_json_file(edit_file(id), [&](const Json& j) {
    std::vector<std::pair<std::string, std::string>> inputs;
    for (const auto& [name, hash] : j.at("inputs").items()) {
      const fs::path path =
          file("edits") / id / fs::path(name).filename();  // never beyond the edit's own folder
      std::string bytes = read_file(path);
      if (content_hash(bytes) != hash.get<std::string>())
        fail("{} is not the file that edit {} was made from; restore it from a copy of the project.",
             path.string(), id);
      inputs.emplace_back(name, std::move(bytes));
    }
    return inputs;
  });
}

void Project::move_to(const Stack& next, Json event) {
  require_writable();
  if (const auto id = first_stale(next)) fail("Edit {} must be remade first (an error in the program).", *id);
  save_stack(next);
  add_history(std::move(event));
}

void Project::forget_set_aside() {
  Stack next = stack_;
  next.forget();
  move_to(next, {{"do", "forget"}});
  collect_garbage();
}

std::string Project::undo() {
  Stack next = stack_;
  const std::string id = next.undo();
  move_to(next, {{"do", "undo"}, {"id", id}});
  return id;
}

std::string Project::redo() {
  Stack next = stack_;
  const std::string id = next.redo();
  move_to(next, {{"do", "redo"}, {"id", id}});
  return id;
}

bool Project::toggle(const std::string& id) {
  Stack next = stack_;
  const bool enabled = next.toggle(id);
  move_to(next, {{"do", "toggle"}, {"id", id}, {"enabled", enabled}});
  return enabled;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The edits of a project: records, results, and the scene made of them.
#include <algorithm>
#include <map>
#include <optional>

#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/base/rollback.h"
#include "core/base/system.h"
#include "engine/project/json_file.h"
#include "engine/project/project.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

std::string object_of(const Json& j) { return j.at("object").get<std::string>(); }

constexpr const char* kAnyKey = "";  // key of the only result of an edit in format 1

}  // namespace

// A stored result of an edit.
struct Project::StoredResult {
  std::string file;    // that names it
  std::string key;     // hash of what it depends on
  std::string object;  // its tensors
  std::string head;    // JSON
  Aspects changes;
  std::string fingerprint;  // of object and head

  bool fits(const std::string& k) const { return key == kAnyKey || key == k; }
};

struct Project::StoredEdit {
  fs::file_time_type time;  // of the file, and its bytes
  uintmax_t bytes = 0;
  Aspects depends;
  std::string record;  // JSON of the rest; as text it takes a quarter of the memory
  std::vector<StoredResult> results;
};

struct Project::StoredEdits {
  std::map<std::string, StoredEdit> of;  // by id
};

// Results of the active edits, in order, up to the first that must be remade.
struct Project::Resolved {
  std::vector<StoredResult> results;
  std::string stale, stale_key;  // of that edit; empty: there is none
};

Project::StoredEdit Project::read_stored(const std::string& id) const {
  return read_json_file(edit_file(id), [&](const Json& j) {
    const std::string file = edit_file(id).string();
    StoredEdit edit;
    if (j.contains("depends")) edit.depends = aspects_from_json(j.at("depends"));
    const auto add = [&](const std::string& key, const Json& r, std::optional<Aspects> changes) {
      JsonReader result(r, "A result in " + file);
      const auto object = result.require<std::string>("object");
      const std::string head = result.member("head").dump();
      edit.results.push_back({file, key, object, head,
                              changes ? *changes : aspects_from_json(result.array("changes")),
                              content_hash(object + head)});
      result.finish();
    };
    if (j.contains("result"))
      add(kAnyKey, j.at("result"), Aspects{.look = true});
    else
      for (const auto& [key, r] : j.at("results").items()) add(key, r, std::nullopt);
    Json rest = j;
    for (const char* key : {"result", "results"}) rest.erase(key);  // "result" is from format 1
    edit.record = rest.dump();
    return edit;
  });
}

const Project::StoredEdit& Project::stored(const std::string& id) const {
  if (!stored_) stored_ = std::make_shared<StoredEdits>();
  std::error_code error;
  const auto time = fs::last_write_time(edit_file(id), error);
  const uintmax_t bytes = error ? 0 : fs::file_size(edit_file(id), error);
  const auto known = stored_->of.find(id);
  if (!error && known != stored_->of.end() && known->second.time == time && known->second.bytes == bytes)
    return known->second;
  StoredEdit& edit = stored_->of[id] = read_stored(id);
  edit.time = time;
  edit.bytes = error ? 0 : bytes;
  return edit;
}

std::vector<std::string> Project::edit_objects(const std::string& id) const {
  std::vector<std::string> objects;
  for (const StoredResult& r : stored(id).results) objects.push_back(r.object);
  return objects;
}

// Keys of results in the order of their edits. What they are hashes of grows with the edits, for each set of
// aspects by itself.
class Project::ResultKeys {
 public:
  explicit ResultKeys(std::string base) : base_(std::move(base)) {}

  // before: those of the call before, and more.
  std::string key(Aspects depends, const std::vector<StoredResult>& before) {
    const int set = depends.shape + 2 * depends.look + 4 * depends.light + 8 * depends.parts;
    auto& [parts, taken] = grown_.try_emplace(set, base_, 0).first->second;
    for (; taken < before.size(); ++taken)
      if (meet(before[taken].changes, depends)) parts += before[taken].fingerprint;
    return content_hash(parts);
  }

 private:
  std::string base_;
  std::map<int, std::pair<std::string, size_t>> grown_;
};

std::string Project::base_object() const { return read_json_file(file("base/scene.json"), object_of); }

Project::Resolved Project::resolve(const Stack& stack) const {
  Resolved out;
  ResultKeys keys(stack.active().empty() ? "" : base_object());
  for (const std::string& id : stack.active()) {
    const StoredEdit& edit = stored(id);
    const std::string key = keys.key(edit.depends, out.results);
    const std::vector<StoredResult>& all = edit.results;
    const auto it = std::find_if(all.begin(), all.end(), [&](const StoredResult& r) { return r.fits(key); });
    if (it == all.end()) {
      out.stale = id;
      out.stale_key = key;
      break;
    }
    out.results.push_back(*it);
  }
  return out;
}

EditLayer Project::load_result(const StoredResult& r) const {
  const auto read = [store = store_, object = r.object, head = r.head, file = r.file] {
    return load_layer(store.get(object), Json::parse(head), "A result in " + file);
  };
  EditLayer layer = shelved(read(), layers_, r.object, read);
  layer.content = r.fingerprint;
  return layer;
}

Scene Project::with_results(const Scene& base, std::span<const StoredResult> results) const {
  std::vector<std::string> keys;
  for (const StoredResult& r : results) keys.push_back(r.fingerprint);
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
  stored_->of.erase(id);
}

void Project::add_edit(const EditRecord& record, const EditLayer& layer, Place place) {
  require_writable();
  if (record.id != stack_.next_id(record.op) || layer.id != record.id)
    fail("Edit '{}' is out of order (an error in the program).", record.id);
  Stack below = stack_, next = stack_;
  if (place == Place::instead_of_last) below.undo();
  place == Place::on_top ? next.push(record.id) : next.amend(record.id);
  const fs::path folder = file("edits") / record.id;
  Rollback guard([&] {
    std::error_code error;
    fs::remove_all(folder, error);
  });
  Json inputs = Json::object();
  for (const auto& [name, bytes] : record.inputs) {
    write_file_atomic(folder / name, bytes);
    inputs[name] = content_hash(bytes);
  }
  write_json_file(
      edit_file(record.id),
      {{"id", record.id},
       {"op", record.op},
       {"op_version", record.op_version},
       {"time", utc_text("%Y-%m-%dT%H:%M:%SZ")},
       {"params", record.params},
       {"inputs", std::move(inputs)},
       {"depends", to_json(record.depends)},
       {"report", record.report},
       {"results",
        store_result(ResultKeys(base_object()).key(record.depends, resolve(below).results), layer)}});
  save_stack(next);
  guard.keep();
  collect_garbage();
  add_history({{"do", record.op}, {"id", record.id}, {"params", record.params}});
}

EditRecord Project::edit(const std::string& id) const {
  if (!stack_.contains(id))
    fail_usage("Project {} has no edit '{}'; `cei3d log` lists them.", folder_.string(), id);
  const StoredEdit& edit = stored(id);
  const Json j = Json::parse(edit.record);
  EditRecord r;
  JsonReader reader(j, edit_file(id).string());
  r.depends = edit.depends;
  r.id = reader.require<std::string>("id");
  r.op = reader.require<std::string>("op");
  r.op_version = reader.require<int>("op_version");
  r.params = reader.member("params");
  r.report = reader.member("report");
  for (const char* key : {"time", "inputs", "depends"}) reader.has(key);  // read elsewhere
  reader.finish();
  return r;
}

std::vector<std::pair<std::string, std::string>> Project::edit_inputs(const std::string& id) const {
  return read_json_file(edit_file(id), [&](const Json& j) {
    std::vector<std::pair<std::string, std::string>> inputs;
    for (const auto& [name, hash] : j.at("inputs").items()) {
      // Never beyond the edit's own folder, whatever the name says.
      const fs::path path = file("edits") / id / fs::path(name).filename();
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

// SPDX-License-Identifier: Apache-2.0
#include "engine/project/stack.h"

#include <algorithm>

#include "core/base/json_reader.h"

namespace cei3d {
namespace {

template <class Entries>
auto find_entry(Entries& entries, const std::string& id) {
  return std::find_if(entries.begin(), entries.end(), [&](const StackEntry& e) { return e.id == id; });
}

std::string known_ids(const std::vector<StackEntry>& entries) {
  std::string list;
  for (const StackEntry& e : entries) list += (list.empty() ? "" : ", ") + e.id;
  return list.empty() ? "there are none" : "there are " + list;
}

// Ids become folder names: nothing but what next_id() makes is let in from a file.
bool is_plain_id(const std::string& id) {
  return id.size() > 5 && id.size() < 100 && std::all_of(id.begin(), id.end(), [](unsigned char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
         });
}

}  // namespace

std::vector<std::string> Stack::active() const {
  std::vector<std::string> ids;
  for (size_t i = 0; i < cursor_; ++i)
    if (entries_[i].enabled) ids.push_back(entries_[i].id);
  return ids;
}

bool Stack::contains(const std::string& id) const { return find_entry(entries_, id) != entries_.end(); }

std::string Stack::next_id(const std::string& op) const { return fmt::format("{:04}-{}", next_, op); }

std::vector<std::string> Stack::push(const std::string& id) {
  std::vector<std::string> dropped;
  for (size_t i = cursor_; i < entries_.size(); ++i) dropped.push_back(entries_[i].id);
  entries_.resize(cursor_);
  entries_.push_back({id, true});
  cursor_ = entries_.size();
  ++next_;
  return dropped;
}

std::string Stack::undo() {
  if (cursor_ == 0) fail_usage("Nothing to undo: there is no edit.");
  return entries_[--cursor_].id;
}

std::string Stack::redo() {
  if (cursor_ == entries_.size()) fail_usage("Nothing to redo: no edit is undone.");
  return entries_[cursor_++].id;
}

bool Stack::toggle(const std::string& id) {
  const auto it = find_entry(entries_, id);
  if (it == entries_.end()) fail_usage("No edit '{}': {}.", id, known_ids(entries_));
  it->enabled = !it->enabled;
  return it->enabled;
}

Json Stack::to_json() const {
  Json edits = Json::array();
  for (const StackEntry& e : entries_) edits.push_back({{"id", e.id}, {"enabled", e.enabled}});
  return {{"edits", std::move(edits)}, {"cursor", cursor_}, {"next", next_}};
}

Stack Stack::from_json(const Json& j, const std::string& file) {
  Stack stack;
  JsonReader reader(j, file);
  for (const Json& e : reader.array("edits")) {
    JsonReader entry(e, "An edit in " + file);
    stack.entries_.push_back({entry.require<std::string>("id"), entry.require<bool>("enabled")});
    entry.finish();
  }
  stack.cursor_ = reader.require<size_t>("cursor");
  stack.next_ = reader.require<int>("next");
  reader.finish();
  if (stack.cursor_ > stack.entries_.size()) fail("{} is damaged: its cursor is beyond the last edit.", file);
  for (const StackEntry& e : stack.entries_)
    if (!is_plain_id(e.id)) fail("{} is damaged: '{}' is not an edit's name.", file, e.id);
  return stack;
}

}  // namespace cei3d

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

Json entries_json(const std::vector<StackEntry>& entries) {
  Json list = Json::array();
  for (const StackEntry& e : entries) {
    list.push_back({{"id", e.id}, {"enabled", e.enabled}});
    if (!e.name.empty()) list.back()["name"] = e.name;
  }
  return list;
}

std::vector<StackEntry> entries_from(const Json& list, const std::string& file) {
  std::vector<StackEntry> entries;
  for (const Json& e : list) {
    JsonReader entry(e, "An edit in " + file);
    entries.push_back({entry.require<std::string>("id"), entry.require<bool>("enabled"),
                       entry.optional("name", std::string())});
    entry.finish();
    if (!is_plain_id(entries.back().id))
      fail("{} is damaged: '{}' is not an edit's name.", file, entries.back().id);
  }
  return entries;
}

}  // namespace

std::vector<std::string> Stack::active() const {
  std::vector<std::string> ids;
  for (size_t i = 0; i < cursor_; ++i)
    if (entries_[i].enabled) ids.push_back(entries_[i].id);
  return ids;
}

bool Stack::contains(const std::string& id) const {
  const auto in = [&](const std::vector<StackEntry>& e) { return find_entry(e, id) != e.end(); };
  return in(entries_) ||
         std::any_of(set_aside_.begin(), set_aside_.end(), [&](const SetAside& s) { return in(s.entries); });
}

std::vector<std::string> Stack::all_ids() const {
  std::vector<std::string> ids;
  for (const StackEntry& e : entries_) ids.push_back(e.id);
  for (const SetAside& s : set_aside_)
    for (const StackEntry& e : s.entries) ids.push_back(e.id);
  return ids;
}

std::string Stack::next_id(const std::string& op) const { return fmt::format("{:04}-{}", next_, op); }

void Stack::set_aside_from(size_t first) {
  if (first >= entries_.size()) return;
  const auto begin = entries_.begin() + std::ptrdiff_t(first);
  set_aside_.push_back({first == 0 ? "" : entries_[first - 1].id, {begin, entries_.end()}});
  entries_.resize(first);
  cursor_ = std::min(cursor_, first);
}

void Stack::push(const std::string& id) {
  set_aside_from(cursor_);
  entries_.push_back({id, true});
  cursor_ = entries_.size();
  ++next_;
}

void Stack::amend(const std::string& id) {
  if (cursor_ == 0) fail("There is no edit to amend (an error in the program).");
  set_aside_from(cursor_);
  const std::string old = entries_.back().id;
  entries_.back().id = id;
  for (SetAside& s : set_aside_)
    if (s.after == old) s.after = id;
  ++next_;
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

void Stack::go_to(size_t cursor) {
  if (cursor > entries_.size())
    fail_usage("There is no step {} in the history: it has {} edits.", cursor, entries_.size());
  cursor_ = cursor;
}

void Stack::rename(const std::string& id, const std::string& name) {
  constexpr size_t kLongest = 100;
  const auto it = find_entry(entries_, id);
  if (it == entries_.end()) fail_usage("No edit '{}': {}.", id, known_ids(entries_));
  if (name.size() > kLongest) fail_usage("A name of an edit has at most {} bytes.", kLongest);
  if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; }))
    fail_usage("A name of an edit has no line breaks or other control characters.");
  it->name = name;
}

void Stack::restore(const std::string& id) {
  const auto it = std::find_if(set_aside_.begin(), set_aside_.end(), [&](const SetAside& s) {
    return find_entry(s.entries, id) != s.entries.end();
  });
  if (it == set_aside_.end()) fail_usage("No edit '{}' is set aside; `cei3d log` lists those that are.", id);
  const SetAside restored = std::move(*it);
  set_aside_.erase(it);
  const auto before = find_entry(entries_, restored.after);
  const size_t first = restored.after.empty()     ? 0
                       : before == entries_.end() ? cursor_
                                                  : size_t(before - entries_.begin()) + 1;
  set_aside_from(first);
  entries_.insert(entries_.end(), restored.entries.begin(), restored.entries.end());
  cursor_ = entries_.size();
}

void Stack::forget() { set_aside_.clear(); }

Json Stack::to_json() const {
  Json j = {{"edits", entries_json(entries_)}, {"cursor", cursor_}, {"next", next_}};
  for (const SetAside& s : set_aside_)
    j["set_aside"].push_back({{"after", s.after}, {"edits", entries_json(s.entries)}});
  return j;
}

Stack Stack::from_json(const Json& j, const std::string& file) {
  Stack stack;
  JsonReader reader(j, file);
  stack.entries_ = entries_from(reader.array("edits"), file);
  if (reader.has("set_aside"))
    for (const Json& s : reader.array("set_aside")) {
      JsonReader list(s, "What " + file + " sets aside");
      stack.set_aside_.push_back(
          {list.require<std::string>("after"), entries_from(list.array("edits"), file)});
      list.finish();
    }
  stack.cursor_ = reader.require<size_t>("cursor");
  stack.next_ = reader.require<int>("next");
  reader.finish();
  if (stack.cursor_ > stack.entries_.size()) fail("{} is damaged: its cursor is beyond the last edit.", file);
  return stack;
}

}  // namespace cei3d

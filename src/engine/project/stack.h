// SPDX-License-Identifier: Apache-2.0
// The edit history: ordered edits, each on or off, and a cursor. Undo and redo move the cursor; nothing needs
// an inverse, because the object is the base plus the edits that are on, up to the cursor.
#pragma once

#include <string>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

struct StackEntry {
  std::string id;  // "0001-paint"
  bool enabled = true;
  bool operator==(const StackEntry&) const = default;
};

class Stack {
 public:
  const std::vector<StackEntry>& entries() const { return entries_; }
  size_t cursor() const { return cursor_; }  // entries before it are done, the others undone
  std::vector<std::string> active() const;   // ids that are done and on, in order
  bool contains(const std::string& id) const;

  std::string next_id(const std::string& op) const;  // "0003-paint"; a number is never used twice

  // Adds an edit at the cursor and drops those that were undone. Returns the dropped ids.
  std::vector<std::string> push(const std::string& id);
  std::string undo();                  // id of the edit that is undone now; usage error: nothing left
  std::string redo();                  // id of the edit that is done again; usage error: nothing left
  bool toggle(const std::string& id);  // the new state; usage error: no such edit
  bool operator==(const Stack&) const = default;

  Json to_json() const;
  static Stack from_json(const Json&, const std::string& file);  // file: for errors

 private:
  std::vector<StackEntry> entries_;
  size_t cursor_ = 0;
  int next_ = 1;
};

}  // namespace cei3d

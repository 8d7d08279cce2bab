// SPDX-License-Identifier: Apache-2.0
// The edit history: ordered edits, each on or off, and a cursor. Undo and redo move the cursor; nothing needs
// an inverse, because the object is the base plus the edits that are on, up to the cursor. What a new edit
// displaces is set aside and can be restored.
#pragma once

#include <string>
#include <vector>

#include "core/base/json_fwd.h"

namespace cei3d {

struct StackEntry {
  std::string id;  // "0001-paint"
  bool enabled = true;
  std::string name = {};  // given by the user; empty: none
  bool operator==(const StackEntry&) const = default;
};

// Edits that a later one displaced, in order.
struct SetAside {
  std::string after;  // id of the edit that they followed; empty: none
  std::vector<StackEntry> entries;
  bool operator==(const SetAside&) const = default;
};

class Stack {
 public:
  const std::vector<StackEntry>& entries() const { return entries_; }
  size_t cursor() const { return cursor_; }    // entries before it are done, the others undone
  std::vector<std::string> active() const;     // ids that are done and on, in order
  bool contains(const std::string& id) const;  // also among those set aside
  std::vector<std::string> all_ids() const;    // also of those set aside
  const std::vector<SetAside>& set_aside() const { return set_aside_; }  // the oldest first

  std::string next_id(const std::string& op) const;  // "0003-paint"; a number is never used twice

  void push(const std::string& id);  // adds an edit at the cursor; sets aside those that were undone
  // Puts this edit in place of the last one that is done; sets aside those that were undone. Error: none is.
  void amend(const std::string& id);
  std::string undo();                  // id of the edit that is undone now; usage error: nothing left
  std::string redo();                  // id of the edit that is done again; usage error: nothing left
  bool toggle(const std::string& id);  // the new state; usage error: no such edit
  void go_to(size_t cursor);           // usage error: more than there are edits
  // Usage errors: no such edit; a name with control characters or of more than 100 bytes.
  void rename(const std::string& id, const std::string& name);
  // Puts the edits that were set aside together with this one back behind the edit that they followed, as
  // done; those that stand there now are set aside. Usage error: it is not set aside.
  void restore(const std::string& id);
  void forget();  // all that is set aside
  bool operator==(const Stack&) const = default;

  Json to_json() const;
  static Stack from_json(const Json&, const std::string& file);  // file: for errors

 private:
  void set_aside_from(size_t first);

  std::vector<StackEntry> entries_;
  std::vector<SetAside> set_aside_;
  size_t cursor_ = 0;
  int next_ = 1;
};

}  // namespace cei3d

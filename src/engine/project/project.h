// SPDX-License-Identifier: Apache-2.0
// The project folder: a reconstructed object, its edits and their inputs.
//
//   project.json            format version, normalization, options of the reconstruction
//   dataset.json            cameras, splits, images (engine/project/dataset.h)
//   base/NNNNNN.ckpt.json   the last two training states; base/latest names the newest
//   base/scene.json         the reconstructed object
//   stack.json              ordered edits, on or off, and the cursor
//   edits/0001-paint/       edit.json, the images it was made from
//   cache/                  what can be computed again; may be deleted at any time
//   objects/ab/cdef...      tensors by content hash
//   history.jsonl           what the user did
//   runs/<time>-<verb>/     logs
//
// Every file is written under a temporary name and renamed, objects before the file that names them: when the
// program dies at any moment, the folder holds the project from before or from after the running change.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/json.h"
#include "core/base/shelf.h"
#include "engine/project/lock.h"
#include "engine/project/scene_cache.h"
#include "engine/project/stack.h"
#include "engine/project/store.h"
#include "model/scene/aspects.h"
#include "model/scene/scene.h"

namespace cei3d {

// 1: one result per edit. 2: one result per state that the edit depends on. 3: the correction network has
// features of its own. 4: materials may vary over the surface. 5: displaced edits are set aside. 6: residual
// images, rings of a turntable.
inline constexpr int kProjectVersion = 6;

struct ProjectHead {
  Normalization normalization;
  Json options;  // of the reconstruction, as its user gave them
};

struct EditRecord {
  std::string id;      // "0001-paint"
  std::string op;      // "paint"
  int op_version = 1;  // of the operation
  Json params;         // of the edit: view, seed, ...; lengths and positions in the capture frame
  Aspects depends;     // aspects of the scene below that its result depends on, besides the base
  Json report;         // of its result: points, seconds, ...
  // File name, bytes; empty when read back, see Project::edit_inputs().
  std::vector<std::pair<std::string, std::string>> inputs;
};

struct TrainingState {
  Json head;
  Tensors tensors;
};

// For one thread at a time: reading fills caches. The scenes that it returns are immutable and may be used
// from any number of threads, also after the project was changed or closed. Their layers read what memory has
// no room for from the folder again.
class Project {
 public:
  enum class Mode { read, write };

  static bool is_project(const std::filesystem::path& folder);
  // The usage errors of create(), before anything is computed.
  static void check_place(const std::filesystem::path& folder, bool replace);
  // Makes the folder, or with `replace` empties the project that is there (its edits included; renders/ and
  // exports/ stay). Usage error: the folder holds something else, or a project and `replace` is not set.
  // Nothing is left behind when it fails.
  static Project create(const std::filesystem::path& folder, const ProjectHead&, const Capture&,
                        bool replace);
  // Errors: no project, a newer format, damaged files, another writer (Mode::write). Mode::read writes
  // nothing.
  static Project open(const std::filesystem::path& folder, Mode);

  // Where the editor that has it open for writing is found, for the error of another writer.
  void say_address(const std::string& address) const { lock_.say_address(address); }

  // Removes a project without object and training state, which a reconstruction leaves that failed early.
  void discard_if_empty();

  const std::filesystem::path& folder() const { return folder_; }
  const ProjectHead& head() const { return head_; }
  // With the poses and focal lengths that the reconstruction refined, once it is finished.
  const Capture& capture() const { return capture_; }
  RefinedCameras refined_cameras() const;                          // none before the object is finished
  const Capture& given_capture() const { return given_capture_; }  // with the cameras it was given
  const std::string& fingerprint() const { return fingerprint_; }  // of the capture when it was reconstructed
  const Stack& stack() const { return stack_; }

  // Training states: both files of one appear or neither. The last two are kept.
  void save_checkpoint(const TrainingState&);
  std::optional<TrainingState> latest_checkpoint() const;  // the newest that is whole

  void save_base(const Scene&);  // the reconstruction's result, without layers
  bool has_base() const;
  std::string base_key() const;  // changes with the base; empty: there is none
  Scene base() const;            // error when the reconstruction was not finished
  // Base and the edits that are on, up to the cursor. Unchanged parts are kept in memory between calls.
  Scene scene() const;
  const SceneCache& scene_cache() const { return scenes_; }
  // Of the memory for layers, others use so much for what they have made of each layer.
  void share_layer_memory(size_t used);

  // Adds an edit at the cursor, or in place of the last edit that is done. record.id must be
  // stack().next_id(record.op), which is also the layer's.
  enum class Place { on_top, instead_of_last };
  void add_edit(const EditRecord& record, const EditLayer& layer, Place = Place::on_top);
  EditRecord edit(const std::string& id) const;
  std::vector<std::pair<std::string, std::string>> edit_inputs(const std::string& id) const;
  // Takes the place of stack(). event: for history.jsonl. Error: an active edit has to be remade first, see
  // first_stale().
  void move_to(const Stack& next, Json event);
  std::string undo();  // id of the edit
  std::string redo();
  bool toggle(const std::string& id);  // the new state
  void forget_set_aside();             // for good

  // The result of an edit depends on its record, the base and those earlier edits that change an aspect it
  // depends on; all results are kept, by a hash of these. With another stack an active edit may have no
  // result and must be remade: first_stale() is the first such edit, scene_below() its input, add_result()
  // stores its result.
  std::optional<std::string> first_stale(const Stack&) const;
  Scene scene_below(const Stack&, const std::string& id) const;
  // op_version: of the operation that made the result; the report notes if the edit was first made by another
  // version.
  void add_result(const Stack&, const std::string& id, const EditLayer& layer, int op_version);

  void add_history(Json event);                            // one line of history.jsonl; "time" is added
  std::filesystem::path new_run(const std::string& verb);  // makes runs/<time>-<verb>

 private:
  Project(std::filesystem::path folder, Mode mode);
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  void require_writable() const;
  void save_stack(const Stack&);
  std::vector<std::filesystem::path> checkpoint_files() const;  // newest first
  struct StoredResult;
  struct Resolved;
  std::filesystem::path edit_file(const std::string& id) const {
    return folder_ / "edits" / id / "edit.json";
  }
  struct StoredEdit;
  struct StoredEdits;
  // What edit.json says, read anew when the file has changed. Valid until the next call for that edit.
  const StoredEdit& stored(const std::string& id) const;
  StoredEdit read_stored(const std::string& id) const;
  std::vector<std::string> edit_objects(const std::string& id) const;
  class ResultKeys;
  std::string base_object() const;
  Resolved resolve(const Stack&) const;
  Json store_result(const std::string& key, const EditLayer& layer);
  EditLayer load_result(const StoredResult&) const;
  Scene with_results(const Scene& base, std::span<const StoredResult>) const;  // the base and those
  void collect_garbage();

  // Memory for the layers' regions and networks, and for what others have made of each layer: a few hundred
  // strokes. Where the layers of one view do not fit, a new view reads most of them again. At least so much
  // is for the former.
  static constexpr size_t kMaxLayerBytes = size_t(128) << 20, kMinLayerBytes = size_t(32) << 20;
  std::filesystem::path folder_;
  ProjectLock lock_;
  ProjectHead head_;
  Capture given_capture_, capture_;
  std::string fingerprint_;
  Stack stack_;
  ObjectStore store_;
  // Cache of base(): the last scene and its hash, so that scenes of one project share their surface and what
  // depends on it.
  mutable std::string loaded_key_;
  mutable Scene loaded_base_;
  mutable SceneCache scenes_;
  mutable std::shared_ptr<StoredEdits> stored_;
  std::shared_ptr<Shelf> layers_ = std::make_shared<Shelf>(kMaxLayerBytes);
};

}  // namespace cei3d

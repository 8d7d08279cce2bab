// SPDX-License-Identifier: Apache-2.0
// All that a user can ask for, as functions: the command line (and later the server) only parse, call one of
// these and print what comes back. Lengths and positions are in the capture's frame and units at this edge.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/base/progress.h"
#include "engine/capture/capture.h"
#include "engine/reconstruct/reconstruct.h"
#include "engine/session/requests.h"

namespace cei3d {

class Device;
class Project;
class RenderCache;
class Threads;
struct Scene;
using EditInputs = std::vector<std::pair<std::string, std::string>>;  // file name, bytes

// For one thread at a time; it works on several of its own. Several sessions, each with its own project, may
// be used by several threads at the same time.
class Session {
 public:
  // device: core/compute/device.h make_device(). threads: 0 takes every core.
  explicit Session(const std::string& device = "auto", int threads = 0);
  ~Session();

  const Device& device() const { return *device_; }
  const Threads& threads() const { return *threads_; }
  // What frames of the open project share, for measurements and tests; a new one with every open().
  RenderCache& frames() { return *frames_; }

  // Without a project.
  static MachineInfo machine();
  CheckReport check(const CheckRequest&);

  // Makes a project, or goes on with one; it is open for writing afterwards. Interrupted Error: its state is
  // saved.
  ReconstructReport reconstruct(const ReconstructRequest&, Progress&);

  // Everything below needs an open project; a second call opens another.
  enum class Access { read, write };
  void open(const std::filesystem::path& project, Access);
  void close();  // lets go of the project and its lock
  ProjectInfo info() const;
  std::vector<LogEntry> log() const;
  Scene scene() const;  // the object as it is: base and the edits that are on
  // Edits. Each adds a layer at the cursor of the history; when one fails, nothing has changed.
  EditSummary paint(const PaintCommand&, Progress&);
  EditSummary change_material(const MaterialCommand&, Progress&);
  EditSummary change_light(const LightChoice&, Progress&);
  EditSummary deform(const DeformCommand&, Progress&);
  EditSummary remove(const RemoveCommand&, Progress&);
  EditSummary select_part(const PartCommand&, Progress&);
  ChangeSummary show_change(const ChangeRequest&);  // of an edit that is on
  // Edits that depend on what comes or goes are made anew. Errors: one of them can't be; nothing has changed
  // then.
  std::string undo(Progress&);  // id of the edit that is undone now
  std::string redo(Progress&);
  bool toggle(const std::string& id, Progress&);  // the new state
  // Makes the edits of this project, those that are done, on top of another one's; those that are off are
  // switched off there, too. Error: one can't be made there; those before it stand.
  ReplayReport replay(const std::filesystem::path& on, Progress&);
  std::vector<PartInfo> parts() const;  // by name
  PartMasksReport part_masks(const PartMasksRequest&, Progress&) const;
  RenderReport render(const RenderRequest&, Progress&);
  ExportReport export_to(const ExportRequest&, Progress&);
  EvalReport evaluate(const EvalRequest&, Progress&);

 private:
  Project& project() const;  // error when none is open
  EditSummary add_edit(const char* op, Json params, EditInputs inputs, Progress&);

  ReconstructReport run_reconstruction(const ReconstructRequest&, Progress&);

  std::unique_ptr<Device> device_;
  std::unique_ptr<Threads> threads_;
  std::unique_ptr<Project> project_;
  std::unique_ptr<RenderCache> frames_;  // of the open project
};

}  // namespace cei3d

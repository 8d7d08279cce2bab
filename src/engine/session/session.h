// SPDX-License-Identifier: Apache-2.0
// The facade of the program: one method per command. The command line parses, calls one of these and prints
// the result. Lengths and positions are in the capture frame and its units.
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
#include "engine/session/look_requests.h"
#include "engine/session/requests.h"

namespace cei3d {

class Device;
class Project;
class RenderCache;
class SamMemory;
class Threads;
class Stack;
class TiledFrame;
struct Appearance;
struct EditPlan;
struct EditPreview;
struct Scene;

// For one thread at a time; it computes on several threads. Several sessions, each with its own project, may
// be used by different threads at the same time.
class Session {
 public:
  // device: a spec of make_device() in core/compute/device.h. threads: 0: one per core.
  explicit Session(const std::string& device = "auto", int threads = 0);
  ~Session();

  const Device& device() const { return *device_; }
  const Threads& threads() const { return *threads_; }
  // The cache of the open project, for measurements and tests; open() replaces it.
  RenderCache& frames() { return *frames_; }

  // Without a project.
  static MachineInfo machine();
  CheckReport check(const CheckRequest&);

  // Makes a project or resumes one, which is open for writing afterwards. Interrupted Error: the state is
  // saved.
  ReconstructReport reconstruct(const ReconstructRequest&, Progress&);

  // All methods below need an open project; a second open() replaces it.
  enum class Access { read, write };
  void open(const std::filesystem::path& project, Access);
  void close();  // releases the project and its lock
  // Where the editor that uses this session is found: others that want to change its project are told.
  void say_address(const std::string& address);
  ProjectInfo info() const;
  std::vector<LogEntry> log() const;
  Scene scene() const;  // the present object: base and active edits
  // Edits. Each adds a layer at the cursor of the history; a failed edit changes nothing.
  EditSummary paint(const PaintCommand&, Progress&);
  EditSummary change_material(const MaterialCommand&, Progress&);
  EditSummary change_light(const LightChoice&, Progress&);
  EditSummary deform(const DeformCommand&, Progress&);
  EditSummary remove(const RemoveCommand&, Progress&);
  EditSummary select_part(const PartCommand&, Progress&);
  // An edit of any kind. amend: in place of the last edit, which must be of the same kind and on the same
  // part, so that several tries are one step of the history.
  EditSummary edit(const EditCommand&, Progress&, bool amend = false);
  // An edit without input files by the parameters that log() shows of one like it.
  EditSummary edit_by_params(const std::string& op, const Json& params, Progress&);
  // An edit in two steps: what preview() makes is not stored before commit(). Error of commit(): the history
  // has changed since.
  std::shared_ptr<const EditPreview> preview(const EditCommand&, Progress&, bool amend = false);
  EditSummary commit(const EditPreview&);
  ChangeSummary show_change(const ChangeRequest&);  // of an edit that is on
  // Edits that depend on the one that appears or disappears are remade. Error: one of them cannot be remade;
  // nothing is changed.
  std::string undo(Progress&);  // id of the edit that is undone now
  std::string redo(Progress&);
  bool toggle(const std::string& id, Progress&);  // the new state
  void go_to(size_t done, Progress&);             // so many edits are done then
  void rename(const std::string& id, const std::string& name);
  // Brings back the edits that were set aside together with this one; see Stack::restore().
  void restore(const std::string& id, Progress&);
  void forget_set_aside();
  // Makes the edits of this project that are done on top of those of another project; edits that are off are
  // switched off there. Error: an edit cannot be made there; those before it are kept.
  ReplayReport replay(const std::filesystem::path& on, Progress&);
  std::vector<PartInfo> parts() const;  // sorted by name
  PartMasksReport part_masks(const PartMasksRequest&, Progress&) const;
  RenderReport render(const RenderRequest&, Progress&);
  // A frame that is computed tile by tile; on_top: with this edit, too. It shows the object as it is now,
  // whatever is edited meanwhile, and must not outlive the open project.
  std::unique_ptr<TiledFrame> frame(const FrameRequest&, const EditPreview* on_top = nullptr);
  bool frame_is_quick() const;  // no light has to be computed for it that takes seconds
  // The object after the first `done` edits of the history: RGBA, sRGB, straight alpha. Errors: there are not
  // so many; an edit would have to be remade.
  Image step_picture(const FrameRequest&, size_t done);
  // The surface seen at a pixel (column, row); none: the background. camera: capture frame.
  std::optional<PickedPoint> pick(const Camera& camera, Vec2<double> pixel) const;
  // The camera, capture frame, whose picture is a decal of width x height pixels that is laid where `camera`
  // sees the surface. None: the background.
  std::optional<Camera> decal_camera(const Camera& camera, const DecalPlace&, int width, int height) const;
  // Where the camera sees the part: 1 channel, share of the pixel. preview: a part that is not stored.
  Image part_picture(const Camera&, const std::string& part, const EditPreview* preview = nullptr);
  std::vector<View> views() const;  // of the capture
  // The object as a page draws it: packs of engine/view by kind, "shape", "coarse", "look", "vertex_light",
  // "light" or "tables". view_keys(): a key for each of these, which changes when the pack does. "sun" is
  // what a sun of a LightChoice adds to any light.
  std::string view_pack(const std::string& kind, const EditPreview* on_top = nullptr);
  Json view_keys() const;
  // The photograph of a view on white, sRGB, 3 channels, at 1/n of its size so that it is at least `width`
  // wide where it was. Error: the view has none, or it cannot be read.
  Image photograph(const std::string& view, int width) const;
  NamedCamera start_camera() const;  // from which the object is well seen
  std::vector<ExportReport> export_to(const ExportRequest&, Progress&);
  EvalReport evaluate(const EvalRequest&, Progress&);

 private:
  Project& project() const;  // error when none is open
  EditPlan plan(const PaintCommand&) const;
  EditPlan plan(const MaterialCommand&) const;
  EditPlan plan(const LightChoice&) const;
  EditPlan plan(const DeformCommand&) const;
  EditPlan plan(const RemoveCommand&) const;
  EditPlan plan(const PartCommand&) const;
  PaintStroke laid_decal(const PaintStroke&) const;  // with camera and scribble instead of the decal
  void move_to(const Stack& next, Json event, Progress&);
  std::unique_ptr<TiledFrame> frame_of(const FrameRequest&, Scene);
  const Appearance& look_of_vertices(const Scene&);
  ReconstructReport run_reconstruction(const ReconstructRequest&, Progress&);
  void begin_frames(Access);  // of the open project, with nothing remembered

  std::unique_ptr<Device> device_;
  std::unique_ptr<Threads> threads_;
  std::unique_ptr<Project> project_;
  std::string address_;                  // of the editor; empty: there is none
  std::unique_ptr<RenderCache> frames_;  // of the open project
  std::unique_ptr<SamMemory> sam_;
  struct VertexLook;
  std::unique_ptr<VertexLook> vertex_look_;  // of the last look that was packed; null: none
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Requests to a Session and its reports: plain data. Each report has a JSON form.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/json.h"
#include "core/base/settings.h"
#include "engine/capture/capture.h"
#include "engine/capture/check.h"
#include "engine/reconstruct/reconstruct.h"
#include "engine/session/edit_requests.h"

namespace cei3d {

struct MachineInfo {
  std::string program;  // version
  std::string processor;
  int cores = 0;
  double memory_gib = 0;
  std::vector<std::string> devices;  // that make_device() knows here, the one "auto" takes last
  Json json() const;
};

struct CheckRequest {
  std::filesystem::path capture;
  CaptureOptions options{"", ReconstructOptions().test_every};  // as `reconstruct` would load it
  // Files to write; empty: none.
  std::filesystem::path picture;          // PNG of cameras and bounding sphere, or HTML page of everything
  std::filesystem::path contact_sheet{};  // PNG of all views
  std::filesystem::path fixed{};          // folder of a capture without what can be repaired safely
};
// How `reconstruct` loads the capture.
CaptureOptions capture_options(const std::string& format, const ReconstructOptions&);
struct CheckReport {
  Capture capture;
  // Findings that were repaired; capture and report are those of the new capture.
  std::vector<std::string> repaired;
  CaptureReport report;
  double object_radius = 0;  // of its bounding sphere, when the report has a normalization
  Json json() const;
};

struct ReconstructRequest {
  std::filesystem::path capture;  // with `resume` may be empty: that of the project
  std::filesystem::path project;
  std::string format;          // of the capture; empty: detected from the files
  ReconstructOptions options;  // not read with `resume`: those of the project are used
  bool resume = false, replace = false;
  bool strict = false;  // refuse a capture of which images are missing
  ShowPicture show{};
};
// The settings of a preset or of a kind of edit, for --list-settings.
struct SettingsReport {
  struct Line {
    SettingInfo info;
    Json value;
    bool fitted = false;  // chosen by the size of a pixel on the object, unless it is set
  };
  std::string kind, name;  // "preset" "fast"; "edit" "paint"
  std::vector<Line> settings;
  Json json() const;
  std::string text() const;
};
// Usage error: no such preset.
SettingsReport settings_of_preset(const std::string& preset);
// edit: "paint", "part" or "deform"; the others have none.
SettingsReport settings_of_edit(const std::string& edit);
// Usage errors: those of add_setting().
Json settings_from_text(const std::vector<std::string>& written);

// Material and light of the object, and how well they explain the photographs.
struct ObjectSummary {
  Material mean;
  bool varies = false;                         // the material, over the surface
  float metal_share = 0;                       // of the surface
  float min_roughness = 0, max_roughness = 0;  // of all but the smoothest and the roughest twentieth
  std::optional<Explained> explained;          // none: not measured
  LightMotion light_motion = LightMotion::world;
  std::optional<Vec3f> light_error;  // relative, of the strength of its channels; none: not known
  size_t refined_poses = 0;          // training views whose poses the reconstruction moved
  double focal = 1;                  // factor on the focal lengths of the capture that it found
  // Standard deviation of the logarithm of the photographs' exposures; 0: they are taken for equal.
  double exposures = 0;
  // A sentence if light and material alone explain the photographs much worse than with the correction
  // network; else empty.
  std::string warning() const;
  std::string text() const;  // material and light in one line
  std::string material_text() const, light_text() const;
  Json json() const;
};

struct ReconstructReport {
  double seconds = 0;
  size_t views = 0;
  int downscale = 1;  // the photographs were used at 1/N of their size
  size_t handler_points = 0, vertices = 0;
  ObjectSummary object;
  Json json() const;
};

struct ProjectInfo {
  std::filesystem::path folder, capture_root;
  std::string capture_format;
  bool finished = false;        // the reconstruction is complete
  size_t views[3] = {0, 0, 0};  // train, val, test
  Normalization normalization;
  Json options;  // of the reconstruction
  // The members below are filled only if `finished`.
  ObjectSummary object;
  size_t vertices = 0, triangles = 0, handler_points = 0, lobes = 0;
  float handler_spacing = 0;  // capture units
  size_t edits = 0, edits_active = 0;
  uintmax_t bytes = 0;  // on disk
  Json json() const;
};

struct LogEntry {
  std::string id, op;
  bool enabled = true, done = true;  // done: not undone
  Json params, report;
  std::string name;        // given by the user; empty: none
  bool set_aside = false;  // displaced by a later edit; `restore` puts it back
  Json json() const;
};

// One view without an edit and with it.
struct ChangeRequest {
  std::string id;                 // of the edit
  std::string view;               // empty: the view that the edit was made in, else the first held-out view
  std::filesystem::path picture;  // PNG, before and after side by side on white; empty: none
  int samples = 2;
};
struct ChangeSummary {
  std::string view;
  size_t pixels_inside = 0, pixels_changed = 0, changed_outside = 0;
  Json json() const;
};

struct ReplayReport {
  std::vector<std::pair<std::string, std::string>> edits;  // id in the project replayed, id in the other one
  std::vector<std::string> notes;                          // sentences on what may differ
  Json json() const;
};

struct PartInfo {
  std::string name, edit;  // id of the edit that defines it
  size_t points = 0;       // vertices of the present surface
  double share = 0;        // of all of them
  Json json() const;
};

struct CaptureViews {
  std::filesystem::path path;
  std::optional<Split> split;
};
struct CameraFile {
  std::filesystem::path path;  // a render.json, or {"cameras": [...]} like one
};
struct Turntable {
  int frames = 0;
};
struct ProjectViews {};  // the project's held-out views, or all when it has none
// Which cameras to render.
using CameraChoice = std::variant<ProjectViews, CaptureViews, CameraFile, Turntable>;
bool shows_photographs(const CameraChoice&);        // whether they are views of a capture
bool is_camera_file(const std::filesystem::path&);  // whether it is JSON with a list "cameras"

// Names as on the command line; none: unknown name.
enum class Channel { rgb, albedo, diffuse, specular, normal, depth, roughness, metalness, mask };
const char* channel_name(Channel);
std::optional<Channel> channel_from_name(const std::string&);

// One camera, capture frame: FILE.json of `--camera`. Errors: unreadable, not exactly one camera.
Camera read_camera(const std::filesystem::path&);
void check_camera(const Camera&, const std::string& what);  // error: no size, focal length or rotation

struct RenderRequest {
  std::filesystem::path out;
  CameraChoice cameras;
  std::vector<Channel> channels{Channel::rgb};
  int width = 0, height = 0;  // 0: the cameras' own
  LightChoice light;
  int samples = 2;       // per pixel and axis
  bool residual = true;  // with the correction, which is never used under another light
};
struct RenderReport {
  size_t views = 0;
  double seconds = 0, trace_seconds = 0, shade_seconds = 0;
  std::vector<std::filesystem::path> folders;  // one per channel
  Json json() const;
};

// The mask of a part in each view: OUT/<view>.png, gray, share of the pixel that shows the part.
struct PartMasksRequest {
  std::filesystem::path out;
  CameraChoice cameras;
  std::string part;
  int samples = 2;  // per pixel and axis
};
struct PartMasksReport {
  size_t views = 0, shown = 0;  // shown: views that show the part
  double seconds = 0;
  Json json() const;
};

// What an asset is for: how many faces and texels it has, and how its pictures are stored.
enum class ExportFor { any, web, ar, dcc };
std::optional<ExportFor> export_for_from_name(const std::string&);  // "web", "ar", "dcc"

// How the pictures of an asset are stored.
enum class ExportImage { png, jpeg, webp };
std::optional<ExportImage> export_image_from_name(const std::string&);  // "png", "jpeg", "webp"

// Meters. Far beyond what is photographed, and far within what the numbers of a file can hold.
inline constexpr double kMinExportLength = 1e-9, kMaxExportLength = 1e9;
// Whether a file of this name holds the object with a place and a size: .glb .gltf .obj .usdz .ply.
bool holds_placed_object(const std::filesystem::path&);

struct ExportRequest {
  // One or more files, all or none of which are written; textures are made once, their names are those of the
  // first textured file. The suffix says what is written: .glb .gltf .obj .usdz .ply (the object), .html (a
  // page that shows it), .hdr .exr .npy .json (the light). Usage error: a wish that none of them can hold.
  std::vector<std::filesystem::path> out;
  bool points = false;  // .ply: the handler points instead of the mesh
  ExportFor purpose = ExportFor::any;
  std::optional<int> faces;          // at most; none: as the purpose says; a mesh without texture: all
  std::optional<int> texture;        // texels of a side; none: as the purpose says; 0: albedo by vertex
  std::optional<ExportImage> image;  // of base color and material; none: as the purpose says
  std::optional<bool> at_base;       // the object stands in the origin; none: as the purpose says
  double unit_scale = 1;             // meters per capture unit
  double size = 0;                   // meters of the longest side, instead of unit_scale; 0: no wish
  bool light = false;                // the light beside the object, as NAME.env.hdr
};
// What was written for one file that was asked for.
struct ExportReport {
  std::filesystem::path out;
  std::vector<std::filesystem::path> files;  // it and those beside it
  size_t vertices = 0, triangles = 0, lobes = 0;
  int texture = 0;  // side in pixels; 0 without one
  size_t charts = 0;
  double used = 0, stretch = 0;         // share of the texture that charts cover; L2 stretch, 1: isometric
  size_t flipped = 0, overlapping = 0;  // triangles of the atlas; texels in more than one triangle
  std::optional<double> simplification_error;  // capture units; none: all faces are exported
  Json json() const;
};

// Networks that the user supplies, see docs/evaluation.md; empty: none, and its score is left out.
struct NetworkFiles {
  std::filesystem::path lpips, fid;
};

struct EvalRequest {
  std::filesystem::path capture;  // empty: the project's own
  std::optional<Split> split;     // none: test when there is one, else all
  int samples = 2;
  bool residual = true;  // with the correction
  NetworkFiles networks;
  std::string edit;                    // also score this edit, an id of the log; empty: none
  std::filesystem::path truth, masks;  // with it: folders of images named like the views; both or none
  // Folder of PNGs to write: photograph, render and, with an edit, edited render, side by side. Empty: none.
  std::filesystem::path pictures;
};
struct ViewScore {
  std::string view;
  double psnr = 0, ssim = 0;
  std::optional<double> psnr_masked;   // none without object pixels
  std::optional<double> psnr_exposed;  // psnr_masked of the render at the exposure of the photograph
  std::optional<double> lpips;
  std::optional<double> flip;  // none in reports of older programs
};
// An edit against true images, inside the true masks.
struct EditFidelity {
  double psnr_inside = 0;
  double iou = 0;  // intersection over union of EditedArea::half and the masks
  size_t pixels_inside = 0, changed_outside = 0, pixels_outside = 0, views = 0;
};
// Pixels of the object outside the edit: edited renders against photographs. Means over views.
struct RestScore {
  double psnr = 0, ssim = 0;
  std::optional<double> lpips, flip;
  size_t pixels = 0, views = 0;
};
struct EditScore {
  std::optional<EditFidelity> truth;
  std::optional<RestScore> rest;  // none if the edit covers the whole object
  std::optional<double> fid;      // between the renders without and with the edit, as in the paper
};
struct EvalReport {
  std::vector<ViewScore> views;
  double psnr = 0, ssim = 0, psnr_masked = 0;  // means over views
  std::optional<double> psnr_exposed;          // mean over views; none in reports of older programs
  double psnr_worst = 0;
  std::string worst_view;
  bool residual = false;  // whether the images include the correction
  struct Alone {
    double psnr = 0, psnr_masked = 0;
  };
  std::optional<Alone> alone;        // means without the correction; none: the object has none
  std::optional<double> lpips, fid;  // fid: between renders and photographs
  std::optional<double> flip;        // mean over views; none in reports of older programs
  std::optional<EditScore> edit;
  Json json() const;
  std::string markdown() const;
};
// What json() wrote; what: it is, in errors. Error: anything else, an unknown key.
EvalReport eval_report_from_json(const Json&, const std::string& what = "The scores");

}  // namespace cei3d

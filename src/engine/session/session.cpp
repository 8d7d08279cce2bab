// SPDX-License-Identifier: Apache-2.0
#include "engine/session/session.h"

#include <thread>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/parallel.h"
#include "core/base/system.h"
#include "core/compute/device.h"
#include "engine/capture/check_page.h"
#include "engine/capture/normalize.h"
#include "engine/capture/write_capture.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/segment/sam_memory.h"
#include "engine/session/object_summary.h"
#include "engine/session/version.h"
#include "engine/session/vertex_look.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

uintmax_t bytes_below(const fs::path& folder) {
  uintmax_t sum = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->is_regular_file(error)) sum += it->file_size(error);
  return sum;
}

void describe_scene(const Device& device, const Scene& scene, ProjectInfo& info) {
  info.object = summary_of(device, scene);
  info.lobes = scene.light.lobes.size();
  if (scene.surface) {
    info.vertices = scene.surface->mesh().positions.size();
    info.triangles = scene.surface->mesh().triangles.size();
  }
  if (scene.handlers) {
    info.handler_points = scene.handlers->positions.size();
    info.handler_spacing = float(scene.handlers->spacing / scene.normalization.scale);
  }
}

// Repairs what can be, until nothing more can: one mistake may hide another. What is written is read again,
// as the next command would.
void write_repaired(const CheckRequest& request, CheckReport& r) {
  for (int round = 0; round < 4; ++round) {
    bool changed = false;
    for (const Finding& f : r.report.findings) {
      if (!f.repair) continue;
      f.repair(r.capture);
      r.repaired.push_back(f.what);
      changed = true;
    }
    if (!changed) break;
    r.report = cei3d::check(r.capture);
  }
  write_capture(r.capture, request.fixed);
  r.capture = load_capture(request.fixed, request.options);
  r.report = cei3d::check(r.capture);
}

}  // namespace

Session::Session(const std::string& device, int threads)
    : device_(std::make_unique<Device>(make_device(device))),
      threads_(std::make_unique<Threads>(threads)),
      frames_(std::make_unique<RenderCache>(*device_)),
      sam_(std::make_unique<SamMemory>(installed_sam())) {}
Session::~Session() = default;

MachineInfo Session::machine() {
  MachineInfo m;
  m.program = kVersion;
  m.processor = processor_name();
  m.cores = int(std::thread::hardware_concurrency());
  m.memory_gib = memory_gib();
  for (const Device& d : all_devices()) m.devices.push_back(d.name());
  return m;
}

CheckReport Session::check(const CheckRequest& request) {
  return threads_->run([&]() -> CheckReport {
    CheckReport r;
    r.capture = load_capture(request.capture, request.options);
    r.report = cei3d::check(r.capture);
    if (!request.fixed.empty()) write_repaired(request, r);
    if (r.report.normalization) r.object_radius = kObjectRadius / r.report.normalization->scale;
    if (request.picture.extension() == ".html")
      write_file_atomic(request.picture, check_page(r.capture, r.report));
    else if (!request.picture.empty() && r.report.normalization)
      write_png(request.picture, draw_cameras(r.capture, *r.report.normalization));
    if (!request.contact_sheet.empty()) write_png(request.contact_sheet, contact_sheet(r.capture, r.report));
    return r;
  });
}

Project& Session::project() const {
  if (!project_) fail("No project is open (an error in the program).");
  return *project_;
}

void Session::open(const fs::path& folder, Access access) {
  close();  // releases the lock first: it may be the same project
  const auto mode = access == Access::write ? Project::Mode::write : Project::Mode::read;
  project_ = std::make_unique<Project>(Project::open(folder, mode));
  say_address(address_);
  if (project_->has_base()) begin_frames(access);
}

void Session::begin_frames(Access access) {
  frames_ = std::make_unique<RenderCache>(
      *device_, RenderCacheLimits(),
      VertexLightFiles(project().folder() / "cache", project().base_key(), access == Access::write));
}

void Session::say_address(const std::string& address) {
  address_ = address;
  if (project_) project_->say_address(address_);
}

void Session::close() {
  project_.reset();
  vertex_look_.reset();
  frames_ = std::make_unique<RenderCache>(*device_);
}

ProjectInfo Session::info() const {
  return threads_->run([&]() -> ProjectInfo {
    const Project& p = project();
    ProjectInfo info;
    info.folder = p.folder();
    info.capture_root = p.capture().root;
    info.capture_format = p.capture().format;
    info.normalization = p.head().normalization;
    info.options = p.head().options;
    info.finished = p.has_base();
    for (const View& v : p.capture().views) ++info.views[size_t(v.split)];
    info.edits = p.stack().entries().size();
    info.edits_active = p.stack().active().size();
    info.bytes = bytes_below(p.folder());
    if (info.finished) describe_scene(*device_, p.base(), info);
    return info;
  });
}

Scene Session::scene() const {
  return threads_->run([&] { return project().scene(); });
}

ReconstructReport Session::reconstruct(const ReconstructRequest& request, Progress& progress) {
  return threads_->run([&] { return run_reconstruction(request, progress); });
}

std::vector<LogEntry> Session::log() const {
  std::vector<LogEntry> entries;
  const Stack& stack = project().stack();
  const auto add = [&](const StackEntry& e, bool done, bool set_aside) {
    const EditRecord r = project().edit(e.id);
    entries.push_back({e.id, r.op, e.enabled, done, r.params, r.report, e.name, set_aside});
  };
  for (size_t i = 0; i < stack.entries().size(); ++i) add(stack.entries()[i], i < stack.cursor(), false);
  for (const SetAside& s : stack.set_aside())
    for (const StackEntry& e : s.entries) add(e, false, true);
  return entries;
}

}  // namespace cei3d

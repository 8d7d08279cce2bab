// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/base/error.h"
#include "core/base/temp_folder.h"
#include "engine/bench/bench.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render.h"
#include "engine/render/render_cache.h"
#include "engine/session/cameras.h"
#include "engine/session/session.h"
#include "engine/session/stopwatch.h"
#include "engine/session/tiled_frame.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr int kSize = 512;  // side of the frame, pixels

BenchFigure seconds_figure(const std::string& subject, std::string name, std::vector<double> seconds) {
  return {"object", subject, std::move(name), "s", false, spread_of(std::move(seconds), false), {}};
}

std::string frame_name(int samples) {
  return fmt::format("512 x 512, {} sample{} a pixel, ", samples * samples, samples > 1 ? "s" : "");
}

void add_frames(const Device& device, const Scene& scene, const Camera& camera, const std::string& subject,
                int repeats, std::vector<BenchFigure>& figures) {
  const SceneLight light(device, scene, scene_transports(scene));
  for (const int samples : {1, 2}) {
    std::vector<double> traced, shaded;
    for (int k = 0; k <= repeats; ++k) {
      Stopwatch watch;
      const GBuffer buffer = trace_view(device, scene, camera, samples);
      const double trace = watch.lap();
      shade_view(device, scene, light, buffer);
      const double shade = watch.lap();
      if (k == 0) continue;  // warms up
      traced.push_back(trace);
      shaded.push_back(shade);
    }
    figures.push_back(seconds_figure(subject, frame_name(samples) + "traced", traced));
    figures.push_back(seconds_figure(subject, frame_name(samples) + "shaded", shaded));
  }
}

// The work of a session for a frame, without writing it.
double frame_seconds(RenderCache& frames, const Scene& scene, const Camera& camera, int samples) {
  Stopwatch watch;
  const auto view = frames.trace(scene, camera, samples);
  frames.shade(scene, frames.light(scene), *view);
  return watch.lap();
}

// Frames after the first one of a session: nothing changed, and another light each time.
void add_later_frames(const Device& device, const Project& project, const Camera& camera,
                      const std::string& subject, int repeats, std::vector<BenchFigure>& figures) {
  for (const int samples : {1, 2}) {
    RenderCache frames(device);
    std::vector<double> again, relit;
    frame_seconds(frames, project.scene(), camera, samples);
    for (int k = 0; k < repeats; ++k) {
      again.push_back(frame_seconds(frames, project.scene(), camera, samples));
      Scene scene = project.scene();
      scene.light = scaled(scene.light, Vec3f{1, 1, 1} * (1 + 0.1f * float(k + 1)));
      relit.push_back(frame_seconds(frames, scene, camera, samples));
      frame_seconds(frames, project.scene(), camera, samples);
    }
    figures.push_back(seconds_figure(subject, frame_name(samples) + "second frame", again));
    figures.push_back(seconds_figure(subject, frame_name(samples) + "second light", relit));
  }
}

// Another frame for the caches that shows the same: the picture is shifted by a thousandth of a pixel.
Camera shifted(Camera camera, int k) {
  camera.cx += 0.001 * k;
  return camera;
}

// New frames of a session as a whole and in the tiles that a window is sent, both under a light that is
// known. The longest tile is the time after which a newer request is heard. camera: capture frame.
void add_tiles(Session& session, const fs::path& folder, const Camera& camera, const std::string& subject,
               int repeats, std::vector<BenchFigure>& figures) {
  session.open(folder, Session::Access::read);
  const Scene scene = session.scene();
  RenderCache frames(session.device());
  frames.light(scene);
  for (const int samples : {1, 2}) {
    std::vector<double> whole, tiled, longest;
    for (int k = 0; k <= repeats; ++k) {
      FrameRequest request;
      request.camera = shifted(camera, k);
      request.samples = samples;
      const double one =
          frame_seconds(frames, scene, scene.normalization.unit_from_capture(request.camera), samples);
      double sum = 0, max = 0;
      Stopwatch watch;
      for (const auto frame = session.frame(request); frame->next();) {
        const double tile = watch.lap();
        sum += tile, max = std::max(max, tile);
      }
      if (k == 0) continue;  // computes the light
      whole.push_back(one), tiled.push_back(sum), longest.push_back(max);
    }
    figures.push_back(seconds_figure(subject, frame_name(samples) + "new view", std::move(whole)));
    figures.push_back(seconds_figure(subject, frame_name(samples) + "new view in tiles", std::move(tiled)));
    figures.push_back(seconds_figure(subject, frame_name(samples) + "longest tile", std::move(longest)));
  }
  session.close();
}

// A disc of a third of the object's size about its middle, as the view shows it.
Image disc_scribble(const Device& device, const Scene& scene, const Camera& camera) {
  const GBuffer buffer = trace_view(device, scene, camera, 1);
  double x = 0, y = 0, n = 0;
  for (size_t p = 0; p + 1 < buffer.pixel_start.size(); ++p)
    if (buffer.pixel_start[p + 1] > buffer.pixel_start[p])
      x += double(p % size_t(camera.width)), y += double(p / size_t(camera.width)), ++n;
  if (n == 0) fail("The project's first view does not show the object.");
  const double radius = std::sqrt(n / M_PI) / 3;
  Image scribble(camera.width, camera.height, 4);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      if (std::hypot(u - x / n, v - y / n) > radius) continue;
      const float color[4] = {0.8f, 0.2f, (u / 4 + v / 4) % 2 ? 0.7f : 0.1f, 1};
      std::copy(color, color + 4, scribble.at(u, v));
    }
  return scribble;
}

// A scribble on the project's first view.
PaintCommand disc_command(const Device& device, const fs::path& folder, const fs::path& scribble) {
  const Project project = Project::open(folder, Project::Mode::read);
  const Scene scene = project.scene();
  const View& view = project.capture().views.front();
  write_png(scribble, disc_scribble(device, scene, scene.normalization.unit_from_capture(view.camera)));
  PaintCommand command;
  command.strokes = {{view.name, scribble}};
  return command;
}

// Times `edit paint` on a fresh copy of the project, a second edit in the same session, and the frame after
// it.
std::vector<BenchFigure> paint_figures(Session& session, const fs::path& folder, const Camera& camera,
                                       const std::string& subject, int repeats, Progress& progress) {
  const TempFolder temp;
  const fs::path copy = temp.path() / "project";
  const PaintCommand command = disc_command(session.device(), folder, temp.path() / "scribble.png");
  std::vector<double> first, second, frame;
  for (int k = 0; k < repeats; ++k) {
    fs::copy(folder, copy, fs::copy_options::recursive);
    Stopwatch watch;
    session.open(copy, Session::Access::write);
    session.paint(command, progress);
    first.push_back(watch.lap());
    frame_seconds(session.frames(), session.scene(), camera, 1);
    watch.lap();
    session.paint(command, progress);
    second.push_back(watch.lap());
    frame.push_back(frame_seconds(session.frames(), session.scene(), camera, 1));
    session.close();
    fs::remove_all(copy);
  }
  return {seconds_figure(subject, "paint edit, a disc of a ninth of the object", std::move(first)),
          seconds_figure(subject, "second paint edit of a session", std::move(second)),
          seconds_figure(subject, frame_name(1) + "after that", std::move(frame))};
}

}  // namespace

std::vector<BenchFigure> bench_object(Session& session, const fs::path& folder, int repeats,
                                      Progress& progress) {
  std::vector<BenchFigure> figures;
  std::string subject;
  Camera camera, seen;
  {
    const Project project = Project::open(folder, Project::Mode::read);
    if (!project.has_base()) fail("{} has no object yet; finish its reconstruction first.", folder.string());
    subject = fmt::format("{}, {} triangles", fs::path(folder / "").parent_path().filename().string(),
                          project.base().surface->mesh().triangles.size());
    progress.report({"frame", 0.7, -1, ""});
    const Scene scene = project.scene();
    seen = choose_cameras(project, ProjectViews{}, kSize, kSize).front().camera;
    camera = scene.normalization.unit_from_capture(seen);
    add_frames(session.device(), scene, camera, subject, repeats, figures);
    add_later_frames(session.device(), project, camera, subject, repeats, figures);
  }
  add_tiles(session, folder, seen, subject, repeats, figures);
  progress.report({"edit", 0.9, -1, ""});
  for (BenchFigure& f : paint_figures(session, folder, camera, subject, repeats, progress))
    figures.push_back(std::move(f));
  return figures;
}

}  // namespace cei3d

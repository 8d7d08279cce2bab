// SPDX-License-Identifier: Apache-2.0
// Requests of the page: from JSON to one call of the Session and back.
#include <algorithm>
#include <array>

#include "apps/server/edit_json.h"
#include "apps/server/editor.h"
#include "apps/server/guarded.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/export/usdz.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/session/edit_plan.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

HttpResponse text_response(std::string json) { return {200, "application/json", std::move(json)}; }
HttpResponse json_response(const Json& j) { return text_response(text_of(j)); }

bool is_number(const std::string& text) {
  return !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

const std::map<std::string, Editor::Route>& Editor::routes() {
  static const std::map<std::string, Route> all = {
      {"edit", &Editor::edit},           {"preview", &Editor::preview},
      {"commit", &Editor::commit},       {"pick", &Editor::pick},
      {"mask", &Editor::mask},           {"undo", &Editor::undo},
      {"redo", &Editor::redo},           {"toggle", &Editor::toggle},
      {"goto", &Editor::go_to},          {"rename", &Editor::rename},
      {"restore", &Editor::restore},     {"forget", &Editor::forget},
      {"export", &Editor::export_file},  {"open", &Editor::open},
      {"close", &Editor::close},         {"reconstruct", &Editor::reconstruct},
      {"cancel", &Editor::cancel},       {"decal", &Editor::decal},
      {"turntable", &Editor::turntable}, {"step", &Editor::step}};
  return all;
}

void Editor::get(const HttpRequest& request, Reply reply) {
  if (request.path == "/api/state") return reply(text_response(state_text()));
  if (request.path == "/api/start") {
    const std::lock_guard lock(mutex_);
    return reply(text_response("{\"state\":" + state_text_ + ",\"object\":" + text_of(object_) + "}"));
  }
  if (request.path == "/api/object") {
    const std::lock_guard lock(mutex_);
    return reply(json_response(object_));
  }
  if (request.path == "/api/making") {
    const std::lock_guard lock(mutex_);
    return reply(making_.empty() ? error_response(404, "There is no picture of it yet.")
                                 : HttpResponse{200, "image/png", making_});
  }
  if (request.path.starts_with("/api/photo/")) return photo(request, std::move(reply));
  if (request.path.starts_with("/api/pack/")) return pack(request, std::move(reply));
  if (request.path.starts_with("/api/download/")) return download(request, std::move(reply));
  reply(error_response(404, "There is no such request."));
}

void Editor::photo(const HttpRequest& request, Reply reply) {
  constexpr int kMin = 16, kMax = 4096, kQuality = 88;
  const auto view = decoded(request.path.substr(std::string("/api/photo/").size()));
  const std::string width = request.parameter("width").value_or("1024");
  if (!view || !is_number(width) || std::stoi(width) < kMin || std::stoi(width) > kMax)
    return reply(error_response(400, "There is no such photograph."));
  worker_->background([reply, view = *view, width = std::stoi(width)](Session& session) {
    reply(guarded_response([&] {
      return HttpResponse{200,
                          "image/jpeg",
                          encode_jpeg(session.photograph(view, width), kQuality),
                          {{"Cache-Control", "private, max-age=3600"}}};
    }));
    return false;
  });
}

void Editor::upload(const HttpRequest& request, Reply reply) {
  if (request.body.empty()) return reply(error_response(400, "The file is empty."));
  reply(guarded_response([&] {
    return json_response({{"id", uploads_.add(request.parameter("name").value_or("file"), request.body)}});
  }));
}

void Editor::edit(JsonReader& j, const HttpRequest& request, Reply reply) {
  const EditCommand command = edit_command(j.require<std::string>("op"), j.member("params"), uploads_);
  const bool amend = j.optional("amend", false);
  j.finish();
  change(request, std::move(reply), [command, amend](Session& session, Progress& progress) {
    return session.edit(command, progress, amend).json();
  });
}

void Editor::preview(JsonReader& j, const HttpRequest&, Reply reply) {
  const EditCommand command = edit_command(j.require<std::string>("op"), j.member("params"), uploads_);
  const bool amend = j.optional("amend", false);
  j.finish();
  on_worker("preview", std::move(reply), [this, command, amend](Session& session, Progress& progress) {
    const auto made = session.preview(command, progress, amend);
    const std::string token = fmt::format("preview{}", ++tokens_);
    keep(token, made);
    return json_response({{"token", token}, {"report", made->record.report}, {"part", made->layer.part}});
  });
}

void Editor::commit(JsonReader& j, const HttpRequest& request, Reply reply) {
  const auto made = kept(j.require<std::string>("token"));
  j.finish();
  change(request, std::move(reply),
         [made](Session& session, Progress&) { return session.commit(*made).json(); });
}

void Editor::pick(JsonReader& j, const HttpRequest&, Reply reply) {
  const Camera camera = camera_member(j, "camera");
  const auto [x, y] = j.numbers<2>("pixel");
  j.finish();
  on_worker("pick", std::move(reply), [camera, pixel = Vec2<double>{x, y}](Session& session, Progress&) {
    const auto point = session.pick(camera, pixel);
    return json_response(point ? point->json() : Json());
  });
}

void Editor::decal(JsonReader& j, const HttpRequest&, Reply reply) {
  const Camera camera = camera_member(j, "camera");
  const DecalPlace place = decal_place(j);
  const std::array<double, 2> size = j.numbers<2>("size");
  j.finish();
  if (!(size[0] >= 1 && size[1] >= 1 && size[0] < 1e5 && size[1] < 1e5))
    fail_usage("A decal has no such size.");
  on_worker("pick", std::move(reply), [=](Session& session, Progress&) {
    const auto over = session.decal_camera(camera, place, int(size[0]), int(size[1]));
    return json_response(over ? camera_json(*over) : Json());
  });
}

void Editor::mask(JsonReader& j, const HttpRequest&, Reply reply) {
  const FrameRequest frame = frame_request(j, uploads_);
  const auto token = j.optional<std::string>("token");
  auto part = j.optional<std::string>("part");
  j.finish();
  const auto made = token ? kept(*token) : nullptr;
  if (made) part = made->layer.part;
  if (!part) fail_usage("Name a part or a preview.");
  on_worker("mask", std::move(reply), [frame, made, part = *part](Session& session, Progress&) {
    const Image mask = session.part_picture(frame.camera, part, made.get());
    return HttpResponse{200, "image/png", encode_png(mask, 8)};
  });
}

void Editor::step(JsonReader& j, const HttpRequest& request, Reply reply) {
  constexpr int kMaxSide = 512;  // small, because edits wait until the whole picture is computed
  const FrameRequest frame = frame_request(j, uploads_);
  const auto done = j.require<size_t>("done");
  j.finish();
  if (frame.camera.width > kMaxSide || frame.camera.height > kMaxSide)
    fail_usage("A picture of a step has at most {} pixels a side.", kMaxSide);
  worker_->background(
      [this, reply = std::move(reply), frame, done, wanted = request.if_match](Session& session) {
        reply(guarded_response([&] {
          if (!wanted.empty() && wanted != revision())
            return error_response(409, "The history has changed since.");
          return HttpResponse{200, "image/png", encode_png(session.step_picture(frame, done), 8)};
        }));
        return false;
      });
}

void Editor::undo(JsonReader& j, const HttpRequest& request, Reply reply) {
  j.finish();
  change(request, std::move(reply), [](Session& session, Progress& p) { return Json(session.undo(p)); });
}

void Editor::redo(JsonReader& j, const HttpRequest& request, Reply reply) {
  j.finish();
  change(request, std::move(reply), [](Session& session, Progress& p) { return Json(session.redo(p)); });
}

void Editor::toggle(JsonReader& j, const HttpRequest& request, Reply reply) {
  const auto id = j.require<std::string>("id");
  j.finish();
  change(request, std::move(reply),
         [id](Session& session, Progress& p) { return Json(session.toggle(id, p)); });
}

void Editor::go_to(JsonReader& j, const HttpRequest& request, Reply reply) {
  const auto done = j.require<size_t>("done");
  j.finish();
  change(request, std::move(reply), [done](Session& session, Progress& p) {
    session.go_to(done, p);
    return Json(done);
  });
}

void Editor::rename(JsonReader& j, const HttpRequest& request, Reply reply) {
  const auto id = j.require<std::string>("id"), name = j.require<std::string>("name");
  j.finish();
  change(request, std::move(reply), [id, name](Session& session, Progress&) {
    session.rename(id, name);
    return Json(name);
  });
}

void Editor::restore(JsonReader& j, const HttpRequest& request, Reply reply) {
  const auto id = j.require<std::string>("id");
  j.finish();
  change(request, std::move(reply), [id](Session& session, Progress& p) {
    session.restore(id, p);
    return Json(id);
  });
}

void Editor::forget(JsonReader& j, const HttpRequest& request, Reply reply) {
  j.finish();
  change(request, std::move(reply), [](Session& session, Progress&) {
    session.forget_set_aside();
    return Json();
  });
}

void Editor::export_file(JsonReader& j, const HttpRequest&, Reply reply) {
  const ExportRequest request = export_request(j);
  j.finish();
  write_exports(std::move(reply), [request](Session& session, Progress& progress, const fs::path& folder) {
    ExportRequest there = request;
    there.out = {folder / request.out.front()};
    const ExportReport report = session.export_to(there, progress).front();
    return Exports{report.files, report.json()};
  });
}

// There are many frames, so the page gets them in one archive.
void Editor::turntable(JsonReader& j, const HttpRequest&, Reply reply) {
  const std::string name = plain_file_name(j.require<std::string>("file"));
  const RenderRequest request = turntable_request(j);
  j.finish();
  if (!name.ends_with(".zip")) fail_usage("A turntable is a .zip, not {}.", name);
  write_exports(std::move(reply),
                [request, name](Session& session, Progress& progress, const fs::path& folder) {
                  require_writable(folder / name);
                  const TempFolder temp;
                  RenderRequest there = request;
                  there.out = temp.path();
                  const RenderReport report = session.render(there, progress);
                  std::vector<FileBytes> frames;
                  for (const fs::path& pictures : report.folders)
                    for (const auto& e : fs::directory_iterator(pictures))
                      frames.push_back({e.path().filename(), read_file(e.path())});
                  std::ranges::sort(frames, {}, &FileBytes::path);
                  write_file_atomic(folder / name, stored_zip(frames));
                  return Exports{{folder / name}, report.json()};
                });
}

void Editor::write_exports(Reply reply,
                           std::function<Exports(Session&, Progress&, const fs::path& folder)> write) {
  if (read_only_) fail_usage("This object is open read-only.");
  on_worker("export", std::move(reply),
            [this, write = std::move(write)](Session& session, Progress& progress) {
              const Exports made = write(session, progress, exports_folder_);
              Json files = Json::array();
              for (const fs::path& f : made.files) {
                const std::lock_guard lock(mutex_);
                exports_.insert(f.filename().string());
                std::error_code error;
                files.push_back({{"name", f.filename().string()}, {"bytes", fs::file_size(f, error)}});
              }
              return json_response(
                  {{"files", files}, {"folder", exports_folder_.string()}, {"report", made.report}});
            });
}

void Editor::download(const HttpRequest& request, Reply reply) {
  const auto name = decoded(request.path.substr(std::string("/api/download/").size()));
  fs::path file;
  {
    const std::lock_guard lock(mutex_);
    if (name && exports_.contains(*name)) file = exports_folder_ / *name;
  }
  if (file.empty()) return reply(error_response(404, "There is no such export."));
  reply(guarded_response([&] {
    return HttpResponse{200,
                        "application/octet-stream",
                        read_file(file),
                        {{"Content-Disposition", "attachment; filename=\"" + *name + "\""}}};
  }));
}

void Editor::open(JsonReader& j, const HttpRequest&, Reply reply) {
  const auto id = j.require<std::string>("id");
  j.finish();
  on_worker("open", std::move(reply), [this, id](Session& session, Progress&) {
    if (id == "sample" && sample_capture()) {
      open_path(session, *sample_capture());
      return text_response(state_text());
    }
    for (const LibraryEntry& e : home_.empty() ? std::vector<LibraryEntry>() : entries_below(home_))
      if (e.name == id) {
        if (!e.problem.empty()) fail("{}", e.problem);  // the page keeps its list, which has the problem, too
        open_path(session, e.path);
        return text_response(state_text());
      }
    fail_usage("There is no '{}' here.", id);
  });
}

void Editor::close(JsonReader& j, const HttpRequest&, Reply reply) {
  j.finish();
  on_worker("close", std::move(reply), [this](Session& session, Progress&) {
    if (home_.empty()) fail_usage("There is no folder to go back to.");
    session.close();
    show_library();
    return text_response(state_text());
  });
}

void Editor::cancel(JsonReader& j, const HttpRequest&, Reply reply) {
  j.finish();
  for (const char* job : {"edit", "preview", "export", "reconstruct"}) worker_->cancel(job);
  reply(json_response(Json::object()));
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "apps/server/editor.h"

#include <exception>
#include <new>

#include "apps/server/assets.h"
#include "apps/server/guarded.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"
#include "core/base/system.h"

namespace cei3d {
namespace {

int status_of(const Error& e) {
  if (e.code() == ErrorCode::interrupted) return 499;  // the user stopped it
  if (e.code() == ErrorCode::again) return 410;        // what the request refers to is gone
  return e.code() == ErrorCode::usage ? 400 : 422;
}

HttpResponse asset_response(const HttpRequest& r, const std::string& name,
                            const std::filesystem::path& folder) {
  const auto bytes = asset(name, folder);
  if (!bytes) return error_response(404, "There is no such file.");
  const std::string tag = '"' + content_hash(*bytes) + '"';
  if (r.if_none_match == tag) return {304, asset_type(name), "", {{"ETag", tag}}};
  return {200, asset_type(name), *bytes, {{"ETag", tag}, {"Cache-Control", "no-cache"}}};
}

}  // namespace

std::string text_of(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); }

HttpResponse guarded_response(const std::function<HttpResponse()>& work) {
  try {
    return work();
  } catch (const Error& e) {
    return error_response(status_of(e), e.what(), e.hint());
  } catch (const std::bad_alloc&) {
    return error_response(500, "Out of memory.", "Close other programs. Nothing was changed.");
  } catch (const std::exception& e) {
    return error_response(400, e.what());
  }
}

Editor::Editor(const EditorOptions& options, Guard guard) : options_(options), guard_(std::move(guard)) {
  std::error_code error;
  if (!std::filesystem::exists(options.path, error))
    fail_usage("There is no {}; name a project, a capture, or a folder of them.", options.path.string());
  const auto entry = entry_at(options.path);
  if (!entry) home_ = options.path;
  state_ = {{"mode", "opening"}, {"name", entry ? entry->name : options.path.filename().string()}};
  state_text_ = text_of(state_);
  JobListener* const listener = this;
  worker_ = std::make_unique<Worker>(std::make_unique<Session>(options.device, options.threads), listener);
  worker_->edit("open", [this, entry](Session& session, Progress&) {
    try {
      entry ? open_path(session, entry->path) : show_library();
    } catch (const std::exception& e) {
      publish(Json{{"mode", "failed"}, {"error", e.what()}});
    }
  });
}

Editor::~Editor() { stop(); }

void Editor::say_address(const std::string& address) {
  worker_->edit("open", [address](Session& session, Progress&) { session.say_address(address); });
}

void Editor::stop() {
  if (worker_) worker_->end();  // before worker_ becomes null, because the last job may still use it
  worker_.reset();
  const std::lock_guard lock(mutex_);
  held_packs_.clear();
  tabs_.clear();
}

std::optional<HttpResponse> Editor::refuse(const HttpRequest& head) { return guard_.refuse(head); }

size_t Editor::body_limit(const HttpRequest& head) {
  constexpr size_t kJson = size_t(4) << 20, kFile = size_t(256) << 20;
  return head.path == "/api/upload" ? kFile : kJson;
}

void Editor::answer(HttpRequest request, Reply reply) {
  if (!request.path.starts_with("/api/")) {
    const std::string name = request.path == "/"                 ? "editor/index.html"
                             : request.path.starts_with("/app/") ? request.path.substr(5)
                                                                 : "none";
    return reply(guarded_response([&] { return asset_response(request, name, options_.app); }));
  }
  try {
    if (request.method != "POST") return get(request, reply);
    if (request.path == "/api/upload") return upload(request, reply);
    const auto route = routes().find(request.path.substr(5));
    if (route == routes().end()) return reply(error_response(404, "There is no such request."));
    const Json body = request.body.empty() ? Json::object() : parse_json(request.body);
    if (body.is_discarded()) return reply(error_response(400, "The request is not JSON."));
    JsonReader reader(body, "The request");
    (this->*route->second)(reader, request, reply);
  } catch (...) {
    const std::exception_ptr problem = std::current_exception();
    reply(guarded_response([&]() -> HttpResponse { std::rethrow_exception(problem); }));
  }
}

void Editor::on_worker(const std::string& job, Reply reply, Work work) {
  constexpr size_t kMaxWaiting = 16;    // requests, each of which may hold uploaded files
  constexpr size_t kMaxWithPacks = 32;  // so that windows get their packs although changes wait
  if (worker_->edits_waiting() >= (job == "pack" ? kMaxWithPacks : kMaxWaiting))
    return reply(error_response(503, "Too many requests wait; try again when some are done."));
  worker_->edit(job,
                [reply = std::move(reply), work = std::move(work)](Session& session, Progress& progress) {
                  reply(guarded_response([&] { return work(session, progress); }));
                });
}

void Editor::change(const HttpRequest& request, Reply reply, std::function<Json(Session&, Progress&)> make) {
  if (read_only_)
    return reply(error_response(403, "This object is open read-only.",
                                "Open it without --read-only, once no other program changes it."));
  on_worker("edit", std::move(reply),
            [this, wanted = request.if_match, make = std::move(make)](Session& session, Progress& progress) {
              if (!wanted.empty() && wanted != revision())
                return error_response(409, "The history was changed in another window.",
                                      "It is shown now; make your change again.");
              const Json result = make(session, progress);
              publish(session);
              worker_->background([](Session&) {
                give_back_freed_memory();
                return false;
              });
              return HttpResponse{200, "application/json",
                                  "{\"result\":" + text_of(result) + ",\"state\":" + state_text() + "}"};
            });
}

void Editor::keep(const std::string& token, std::shared_ptr<const EditPreview> preview) {
  constexpr size_t kMax = 8;
  const std::lock_guard lock(mutex_);
  previews_.emplace_back(token, std::move(preview));
  if (previews_.size() > kMax) previews_.pop_front();
}

std::shared_ptr<const EditPreview> Editor::kept(const std::string& token) {
  const std::lock_guard lock(mutex_);
  for (const auto& [name, preview] : previews_)
    if (name == token) return preview;
  fail_usage("This preview is gone; make it again.");
}

Json Editor::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

std::string Editor::state_text() const {
  const std::lock_guard lock(mutex_);
  return state_text_;
}

std::string Editor::revision() const {
  const std::lock_guard lock(mutex_);
  return state_.value("revision", "");
}

}  // namespace cei3d

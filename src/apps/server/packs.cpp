// SPDX-License-Identifier: Apache-2.0
// What the page draws. A pack is made once for each key, if there is time even before a page asks for it. A
// request for a pack that is ready is answered at once, without the worker.
#include "apps/server/editor.h"
#include "apps/server/guarded.h"
#include "core/base/json.h"
#include "engine/io/gzip.h"

namespace cei3d {
namespace {

HttpResponse pack_response(const std::string& bytes, bool keyed, bool packed) {
  HttpResponse r{200, "application/octet-stream", packed ? gzip(bytes, Packing::fast) : bytes};
  if (packed) r.headers.emplace_back("Content-Encoding", "gzip");
  if (keyed) r.headers.emplace_back("Cache-Control", "private, max-age=86400");
  return r;
}

}  // namespace

void Editor::pack(const HttpRequest& request, Reply reply) {
  const std::string kind = request.path.substr(std::string("/api/pack/").size());
  const auto token = request.parameter("preview"), key = request.parameter("key");
  const bool keyed = key && !token, packed = request.parameter("packed").has_value();
  if (keyed)
    if (const auto ready = kept_pack(kind, *key)) return reply(pack_response(*ready, true, packed));
  const auto made = token ? kept(*token) : nullptr;
  const auto make = [=, this](Session& session, Progress&) {
    if (made) return pack_response(session.view_pack(kind, made.get()), false, packed);
    const auto bytes = pack_of(session, kind);
    return pack_response(*bytes, keyed && kept_pack(kind, *key), packed);
  };
  {
    constexpr size_t kMaxHeld = 32;
    const std::lock_guard lock(mutex_);
    if (first_frame_ && !made && held_packs_.size() < kMaxHeld)
      return held_packs_.push_back([=, this] { on_worker("pack", reply, make); });
  }
  on_worker("pack", std::move(reply), make);
}

void Editor::release_packs() {
  std::vector<std::function<void()>> held;
  {
    const std::lock_guard lock(mutex_);
    first_frame_ = false;
    held.swap(held_packs_);
  }
  for (const auto& ask : held) ask();
}

void Editor::prepare_packs() {
  for (const char* kind : {"shape", "look", "tables", "light", "vertex_light"})
    worker_->background([this, kind](Session& session) {
      guarded_response([&] { return pack_response(*pack_of(session, kind), false, false); });
      return false;
    });
  worker_->background([this](Session&) {
    release_packs();  // for pages that ask for packs and for no frame
    return false;
  });
}

std::shared_ptr<const std::string> Editor::pack_of(Session& session, const std::string& kind) {
  const std::string key = session.view_keys().value(kind, "");
  if (auto ready = kept_pack(kind, key)) return ready;
  const auto made = std::make_shared<const std::string>(session.view_pack(kind));
  const std::lock_guard lock(mutex_);
  packs_[kind] = {key, made};
  return made;
}

std::shared_ptr<const std::string> Editor::kept_pack(const std::string& kind, const std::string& key) const {
  const std::lock_guard lock(mutex_);
  const auto it = packs_.find(kind);
  return it != packs_.end() && it->second.key == key ? it->second.bytes : nullptr;
}

}  // namespace cei3d

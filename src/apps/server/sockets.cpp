// SPDX-License-Identifier: Apache-2.0
// The WebSocket of a window.
//
// The window sends JSON: first {"type": "hello", "token", "run", "after"}; then {"type": "view", "seq",
// "camera", "samples", "channel", "light", "as_photographed", "preview", "packed"} to get a frame, which
// replaces the one that it asked for before, and {"type": "rest"} when it wants no frame any more.
//
// The program sends JSON: "welcome", "frame" when a frame is complete, "error", and the news. Tiles of a
// frame are bytes: length of the head (4 bytes, little-endian), head (JSON, padded with spaces to a multiple
// of 4), RGBA. "packed": RGBA is compressed by gzip, which windows with a slow connection ask for.
//
// News are messages to all windows: "state", "progress", and "making" when there is a new picture of the
// object that is being reconstructed. They are numbered by "event". A window that reconnects names the run of
// the program and the last number that it got, and is sent the news that it missed. If these are not kept any
// more, "complete" is false, and it is sent the present state instead.
#include <algorithm>

#include "apps/server/edit_json.h"
#include "apps/server/editor.h"
#include "apps/server/guarded.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"
#include "engine/io/gzip.h"
#include "engine/session/tiled_frame.h"

namespace cei3d {
namespace {

std::string tile_message(const FrameTile& tile, uint64_t seq, const FrameRequest& request, bool packed) {
  std::string head = Json{
      {"seq", seq},
      {"x", tile.box.x0},
      {"y", tile.box.y0},
      {"width", tile.box.width},
      {"height", tile.box.height},
      {"frame", {request.camera.width, request.camera.height}},
      {"samples", request.samples},
      {"packed", packed}}.dump();
  head.resize((head.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += char(head.size() >> (8 * i) & 255);
  bytes += head;
  const std::string_view pixels(reinterpret_cast<const char*>(tile.rgba.data()), tile.rgba.size());
  return packed ? bytes + gzip(pixels, Packing::fast) : bytes.append(pixels);
}

Json state_news(const Json& state) {
  return {{"type", "state"}, {"mode", state["mode"]}, {"revision", state.value("revision", "")}};
}

// A frame for a window, which the worker computes tile by tile.
class FrameJob {
 public:
  FrameJob(SocketPtr socket, FrameRequest request, std::shared_ptr<const EditPreview> preview, uint64_t seq,
           bool packed, std::function<void()> ended)
      : socket_(std::move(socket)),
        request_(std::move(request)),
        preview_(std::move(preview)),
        seq_(seq),
        packed_(packed),
        ended_(std::move(ended)) {}

  bool step(Session& session) {
    try {
      if (!frame_) frame_ = session.frame(request_, preview_.get());
      if (const auto tile = frame_->next())
        socket_->send_picture(tile_message(*tile, seq_, request_, packed_), seq_);
      if (frame_->tiles_left() > 0) return true;
      socket_->send(Json{{"type", "frame"}, {"seq", seq_}, {"seconds", steady_seconds() - start_}}.dump());
    } catch (const std::exception& e) {
      socket_->send(Json{{"type", "error"}, {"seq", seq_}, {"error", e.what()}}.dump());
    }
    ended_();
    return false;
  }

 private:
  SocketPtr socket_;
  FrameRequest request_;
  std::shared_ptr<const EditPreview> preview_;
  uint64_t seq_;
  bool packed_;
  std::function<void()> ended_;
  std::shared_ptr<TiledFrame> frame_;
  double start_ = steady_seconds();
};

}  // namespace

void Editor::opened(const SocketPtr& socket) {
  const std::lock_guard lock(mutex_);
  tabs_[socket].name = fmt::format("tab{}", ++tokens_);
}

void Editor::closed(const SocketPtr& socket) {
  std::string name;
  {
    const std::lock_guard lock(mutex_);
    name = tabs_[socket].name;
    tabs_.erase(socket);
  }
  worker_->drop_frame(name);
}

void Editor::received(const SocketPtr& socket, const std::string& text) {
  Tab tab;
  {
    const std::lock_guard lock(mutex_);
    tab = tabs_[socket];
  }
  const Json j = parse_json(text);
  try {
    JsonReader message(j, "The message");
    const auto type = message.require<std::string>("type");
    if (!tab.trusted) return type == "hello" ? hello(socket, message) : socket->close();
    if (type == "view") return show_view(socket, tab.name, message);
    if (type != "rest") fail_usage("There is no message '{}'.", type);
    message.finish();
    worker_->drop_frame(tab.name);
  } catch (const std::exception& e) {
    if (!tab.trusted) return socket->close();
    socket->send(Json{{"type", "error"}, {"error", e.what()}}.dump());
  }
}

void Editor::hello(const SocketPtr& socket, JsonReader& message) {
  const auto token = message.require<std::string>("token");
  const auto run = message.optional<std::string>("run");
  const auto after = message.optional<uint64_t>("after");
  message.finish();
  if (!guard_.knows(token)) return socket->close();
  const bool same_run = run == run_ && after;
  const std::lock_guard lock(mutex_);
  const uint64_t missed = event_ - std::min(after.value_or(0), event_);
  const bool complete = same_run && missed <= news_.size();
  tabs_[socket].trusted = true;
  socket->send(Json{
      {"type", "welcome"}, {"run", run_}, {"event", event_ - (complete ? missed : 0)}, {"complete", complete}}
                   .dump());
  if (complete)
    for (size_t i = news_.size() - missed; i < news_.size(); ++i) socket->send(news_[i]);
  else
    socket->send(state_news(state_).dump());
}

void Editor::show_view(const SocketPtr& socket, const std::string& tab, JsonReader& reader) {
  const auto seq = reader.require<uint64_t>("seq");
  FrameRequest request = frame_request(reader, uploads_);
  const auto token = reader.optional<std::string>("preview");
  const bool packed = reader.optional("packed", false);
  reader.finish();
  auto job = std::make_shared<FrameJob>(socket, std::move(request), token ? kept(*token) : nullptr, seq,
                                        packed, [this] { release_packs(); });
  worker_->frame(tab, [job](Session& session) { return job->step(session); });
}

void Editor::on_progress(const std::string& job, const ProgressReport& r) {
  if (job == "open" || job == "pick" || job == "mask") return;
  broadcast({{"type", "progress"},
             {"job", job},
             {"stage", r.stage},
             {"fraction", r.fraction},
             {"seconds_left", r.seconds_left},
             {"message", r.message}});
}

void Editor::broadcast(Json message) {
  const std::lock_guard lock(mutex_);
  message["event"] = ++event_;
  const std::string text = text_of(message);
  news_.push_back(text);
  if (news_.size() > options_.news_kept) news_.pop_front();
  for (const auto& [socket, tab] : tabs_)
    if (tab.trusted) socket->send(text);
}

}  // namespace cei3d

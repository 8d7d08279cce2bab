// SPDX-License-Identifier: Apache-2.0
// The editor behind the browser: every request becomes one call of the Session, on the worker's thread.
//
//   GET  /                      the page; its modules below /app/
//   GET  /api/state             what is open: history, parts, findings, jobs
//   GET  /api/start             {"state", "object"}: both at once, for a page that is being loaded
//   GET  /api/object            what does not change while an object is open: views, cameras, frame
//   GET  /api/photo/VIEW?width= a photograph, JPEG
//   GET  /api/making            the object that is being reconstructed, PNG
//   GET  /api/pack/KIND?key=    what the page draws, by a key of the state; or ?preview=TOKEN
//                               &packed: by gzip
//   POST /api/upload?name=      bytes in, {"id"} out
//   POST /api/edit              {"op", "params", "amend"}
//   POST /api/preview           makes an edit and does not store it: {"token", "report"}; /api/commit
//                               {"token"} stores it
//   POST /api/pick              {"camera", "pixel"}: the surface there, or null
//   POST /api/decal             {"camera", "decal", "size"}: the camera whose picture the decal is, or null
//   POST /api/mask              {"camera", "part" or "token"}: PNG
//   POST /api/step              {"camera", "samples", "done"}: PNG of the object after the first `done` edits
//   POST /api/undo redo toggle goto rename restore forget
//   POST /api/export            {"file", ...}; then GET /api/download/FILE
//   POST /api/turntable         {"file", "turntable", ...}: the frames in a .zip; then GET /api/download/FILE
//   POST /api/open close reconstruct cancel
//   /socket                     frames, and messages to all windows; see sockets.cpp
//
// A change may carry If-Match: REVISION; it is refused with 409 when the history has changed since.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/server/guard.h"
#include "apps/server/http.h"
#include "apps/server/library.h"
#include "apps/server/uploads.h"
#include "core/base/json_reader.h"
#include "engine/session/worker.h"

namespace cei3d {

struct EditorOptions {
  std::filesystem::path path;     // a project, a capture, or a folder of them
  std::filesystem::path project;  // where a capture's object goes; empty: NAME-object beside the capture
  bool read_only = false;
  std::filesystem::path app;  // folder to read the page from; empty: the page that is embedded in the program
  std::string device = "auto";
  int threads = 0;
  size_t news_kept = 1000;  // messages to all windows, for those that were not connected when they were sent
};

class Editor : public HttpApp, private JobListener {
 public:
  // Errors: the path holds nothing, or cannot be read.
  Editor(const EditorOptions&, Guard);
  ~Editor() override;

  std::optional<HttpResponse> refuse(const HttpRequest&) override;
  size_t body_limit(const HttpRequest&) override;
  void answer(HttpRequest, std::function<void(HttpResponse)> reply) override;
  void opened(const SocketPtr&) override;
  void received(const SocketPtr&, const std::string& text) override;
  void closed(const SocketPtr&) override;

  // The address of the editor, without its key, for the error that another program gets when it wants to
  // change the open project.
  void say_address(const std::string& address);
  // Cancels the running job, which saves its state, and drops all tabs and all replies that were not sent.
  // Must be called before the server is destroyed, because tabs and replies refer to its connections.
  void stop();
  void wait_until_idle() { worker_->wait_until_idle(); }  // for tests

 private:
  using Reply = std::function<void(HttpResponse)>;
  using Work = std::function<HttpResponse(Session&, Progress&)>;
  using Route = void (Editor::*)(JsonReader&, const HttpRequest&, Reply);
  struct Tab {
    bool trusted = false;  // has sent the token
    std::string name;
  };

  // routes.cpp
  static const std::map<std::string, Route>& routes();
  void get(const HttpRequest&, Reply);
  void photo(const HttpRequest&, Reply);
  void pack(const HttpRequest&, Reply);
  void download(const HttpRequest&, Reply);
  void upload(const HttpRequest&, Reply);
  void edit(JsonReader&, const HttpRequest&, Reply);
  void preview(JsonReader&, const HttpRequest&, Reply);
  void commit(JsonReader&, const HttpRequest&, Reply);
  void pick(JsonReader&, const HttpRequest&, Reply);
  void decal(JsonReader&, const HttpRequest&, Reply);
  void mask(JsonReader&, const HttpRequest&, Reply);
  void step(JsonReader&, const HttpRequest&, Reply);
  void undo(JsonReader&, const HttpRequest&, Reply);
  void redo(JsonReader&, const HttpRequest&, Reply);
  void toggle(JsonReader&, const HttpRequest&, Reply);
  void go_to(JsonReader&, const HttpRequest&, Reply);
  void rename(JsonReader&, const HttpRequest&, Reply);
  void restore(JsonReader&, const HttpRequest&, Reply);
  void forget(JsonReader&, const HttpRequest&, Reply);
  void export_file(JsonReader&, const HttpRequest&, Reply);
  void turntable(JsonReader&, const HttpRequest&, Reply);
  void open(JsonReader&, const HttpRequest&, Reply);
  void close(JsonReader&, const HttpRequest&, Reply);
  void reconstruct(JsonReader&, const HttpRequest&, Reply);
  void cancel(JsonReader&, const HttpRequest&, Reply);

  // Files that were written below a folder, and the report about them.
  struct Exports {
    std::vector<std::filesystem::path> files;
    Json report;
  };
  // Writes files on the worker and allows their download. Usage error: read-only.
  void write_exports(Reply, std::function<Exports(Session&, Progress&, const std::filesystem::path& folder)>);
  // Runs the work on the worker; errors become responses. Replies 503 when too many requests wait.
  void on_worker(const std::string& job, Reply, Work);
  // A change of the history; the reply has the new state. Refused when the project is read-only or when the
  // request names another revision than the present one.
  void change(const HttpRequest&, Reply, std::function<Json(Session&, Progress&)>);
  void keep(const std::string& token, std::shared_ptr<const EditPreview>);
  std::shared_ptr<const EditPreview> kept(const std::string& token);  // usage error: it is gone

  // places.cpp: what is open. On the worker's thread.
  void open_path(Session&, const std::filesystem::path&);
  void open_project(Session&, const std::filesystem::path&);
  // Opens for writing if possible, else read-only. Returns why it is read-only; empty: as the user wants it.
  std::string open_for_access(Session&, const std::filesystem::path&);
  void show_unfinished(Session&, const std::filesystem::path&, const ProjectInfo&);  // without its object
  // note: what the user is told about the project when it opens.
  void show_object(Session&, const std::filesystem::path&, const ProjectInfo&, const std::string& note);
  void open_capture(Session&, const std::filesystem::path&);
  void show_library();
  void show_making(const Image&);
  void publish(Session&);  // the present state, to all windows
  // grows: members of the state that grow with the history.
  void publish(Json state, Json grows = Json::object());
  Json state() const;              // without the members that grow
  std::string state_text() const;  // JSON of the whole state
  std::string revision() const;    // of the history; empty: nothing is open
  std::filesystem::path object_folder() const;

  // packs.cpp: what the page draws. The last pack of each kind is kept. Requests for packs of an object that
  // was just opened wait for its first frame, if that is quick.
  struct KeptPack {
    std::string key;
    std::shared_ptr<const std::string> bytes;
  };
  void prepare_packs();  // in the background, before a page asks for them
  void release_packs();  // lets the requests that wait for the first frame go on
  std::shared_ptr<const std::string> pack_of(Session&, const std::string& kind);
  std::shared_ptr<const std::string> kept_pack(const std::string& kind, const std::string& key) const;

  // sockets.cpp
  void on_progress(const std::string& job, const ProgressReport&) override;
  void broadcast(Json);
  void hello(const SocketPtr&, JsonReader& message);
  void show_view(const SocketPtr&, const std::string& tab, JsonReader& message);

  EditorOptions options_;
  Guard guard_;
  Uploads uploads_;
  std::filesystem::path home_;     // the served folder; empty: only one project or capture is served
  std::filesystem::path capture_;  // that is open, or that the open project is to be made from
  std::atomic<bool> read_only_ = false;
  mutable std::mutex mutex_;  // of the members below
  Json state_, object_;
  std::string state_text_;
  std::string making_;  // PNG
  std::deque<std::pair<std::string, std::shared_ptr<const EditPreview>>> previews_;
  std::set<std::string> exports_;  // names of files that may be downloaded
  std::filesystem::path exports_folder_;
  std::map<SocketPtr, Tab> tabs_;
  const std::string run_ = new_token().substr(0, 16);  // names this run of the program
  uint64_t event_ = 0;                                 // number of the last message to all windows
  std::deque<std::string> news_;                       // the last of these messages, oldest first
  std::map<std::string, KeptPack> packs_;              // by kind
  bool first_frame_ = false;                           // packs wait for the object's first frame
  std::vector<std::function<void()>> held_packs_;      // requests for packs that wait for that frame
  std::atomic<uint64_t> tokens_ = 0;
  std::unique_ptr<Worker> worker_;  // last: it uses the others
};

}  // namespace cei3d

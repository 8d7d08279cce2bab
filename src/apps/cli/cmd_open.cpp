// SPDX-License-Identifier: Apache-2.0
// open: the live editor.
#include "apps/cli/command.h"
#include "apps/cli/interrupt.h"
#include "apps/server/serve.h"
#include "core/base/file.h"
#include "core/base/system.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

struct Options {
  ServeOptions serve;
  std::string path, project, app;
  bool browser = true;
};

// The address is handed to the browser in a file that only this user can read: arguments of programs can be
// read by everybody on the machine.
void open_browser(const TempFolder& folder, const std::string& url) {
  const std::filesystem::path page = folder.path() / "open.html";
  write_file_atomic(page, "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url=" + url + "\">");
  open_on_desktop(page);
}

void run_open(const Options& o, const CommonOptions& common, Console& console) {
  ServeOptions serve_options = o.serve;
  EditorOptions& editor = serve_options.editor;
  editor.path = o.path;
  editor.project = o.project;
  editor.app = o.app;
  editor.device = common.device;
  editor.threads = common.threads;
  const TempFolder folder;
  const auto announce = [&](const Address& a) {
    console.answer({{"url", a.url}, {"tunnel", a.tunnel}},
                   fmt::format("The editor is at\n  {}\nFrom another machine, first run there\n  {}\n"
                               "Everything is saved as you go; Ctrl-C ends the editor.\n",
                               a.url, a.tunnel));
    if (o.browser && has_desktop()) open_browser(folder, a.url);
  };
  serve(serve_options, announce, interrupted);
}

}  // namespace

void add_open(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("open", "Open an object, a capture or a folder of them in the live editor");
  verb->add_option("path", o->path, "Project, capture, or a folder of them (default: this folder)")
      ->default_str(".");
  o->path = ".";
  verb->add_option("-o,--output", o->project,
                   "Project folder for the object of a capture (default: NAME-object beside the capture)");
  verb->add_option("--port", o->serve.http.port, "Port; the next free one if it is taken. 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  verb->add_option("--host", o->serve.http.host,
                   "Address to listen at; others than this machine's own need --allow-host")
      ->capture_default_str();
  verb->add_option("--allow-host", o->serve.allowed_hosts,
                   "Name that the browser may use for this machine, besides localhost");
  verb->add_flag_callback(
      "--no-browser", [o] { o->browser = false; }, "Only print the address; do not open the browser");
  verb->add_flag("--read-only", o->serve.editor.read_only, "Show the object; changes are refused");
  verb->add_option("--app", o->app, "Folder to read the page from, for work on it")->group("");
  commands.on(verb, o, [&commands](const Options& options, Session&, Console& console) {
    run_open(options, commands.common(), console);
  });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/cli.h"

#include <algorithm>
#include <new>
#include <optional>
#include <ostream>
#include <sstream>
#include <utility>

#include "apps/cli/command.h"
#include "core/base/error.h"
#include "engine/capture/capture.h"
#include "engine/session/version.h"

namespace cei3d {
namespace {

constexpr const char* kAbout =
    "cei3d: reconstructs an editable, relightable 3D object from posed photographs.\n"
    "\n"
    "  cei3d demo                                             all of it, on the sample capture\n"
    "  cei3d capture PHOTOS -o CAPTURE                        poses and masks for bare photographs\n"
    "  cei3d check CAPTURE                                    check that a capture can be used\n"
    "  cei3d reconstruct CAPTURE -o PROJECT                   reconstruct an object from photographs\n"
    "  cei3d edit PROJECT paint --view NAME --scribble S.png  paint on one view, see it in all\n"
    "  cei3d render PROJECT -o DIR                            images, also under another light\n"
    "  cei3d open PROJECT                                     the live editor, in the browser\n"
    "  cei3d export PROJECT -o OBJECT.glb                     a model file\n"
    "  cei3d COMMAND -h                                       the options of a command";

constexpr const char* kFooter =
    "CAPTURE:train, :val or :test is one split of a capture. A PROJECT is the folder that `reconstruct` "
    "writes.\n"
    "Pixels are (column,row) from the top left corner, centers at +0.5. Positions and lengths are in the\n"
    "capture's own frame and unit.\n"
    "Exit codes: 0 done, 1 failed, 2 wrong usage, 130 interrupted (state saved); of `batch work` also 75, "
    "try again later.";

constexpr const char* kCommandFooter =
    "Options of every command: --quiet, --json, --log-level, --device, --threads (see `cei3d -h`).";

std::string footer() {
  return "A CAPTURE is a folder of posed images with object masks, or the file in it that holds the cameras\n"
         "(.json, .npz, .xml, .csv, .npy or .sfm):\n  " +
         capture_format_layouts("\n  ") + "\n" + kFooter;
}

const std::pair<const char*, LogLevel> kLevels[] = {{"error", LogLevel::error},
                                                    {"warn", LogLevel::warn},
                                                    {"info", LogLevel::info},
                                                    {"debug", LogLevel::debug}};

LogLevel level_of(const CommonOptions& o) {
  if (o.quiet) return LogLevel::error;
  for (const auto& [name, level] : kLevels)
    if (o.log_level == name) return level;
  return LogLevel::info;
}

void add_common(CLI::App& app, CommonOptions& o) {
  app.set_version_flag("--version", std::string("cei3d ") + kVersion, "Print the version");
  app.set_help_flag("-h,--help", "Print this help");
  app.add_flag("-q,--quiet", o.quiet, "Print only answers and errors")->group("Everywhere");
  app.add_flag("--json", o.json, "Print the result as JSON; nothing else goes to standard output")
      ->group("Everywhere");
  app.add_option("--log-level", o.log_level, "What to report on standard error")
      ->check(CLI::IsMember({"error", "warn", "info", "debug"}))
      ->capture_default_str()
      ->group("Everywhere");
  app.add_option("--device", o.device, "Device to compute on: auto, cpu, cpu/scalar, cpu/avx2, cpu/avx512")
      ->capture_default_str()
      ->group("Everywhere");
  app.add_option("--threads", o.threads, "Number of threads; 0: all cores. Results do not depend on it")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str()
      ->group("Everywhere");
}

// Adds those options that every command has, as they were given to this command, to another command line. Not
// --json, because the caller prints the result.
std::vector<std::string> with_common(std::vector<std::string> line, const CommonOptions& o) {
  if (o.quiet) line.push_back("--quiet");
  line.insert(line.end(),
              {"--log-level", o.log_level, "--device", o.device, "--threads", std::to_string(o.threads)});
  return line;
}

// Lines of at most `width` characters, broken at spaces.
std::string wrapped(const std::string& text, size_t width) {
  std::istringstream in(text);
  std::string out, line;
  for (std::string word; in >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      out += line + '\n';
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return out + line;
}

constexpr size_t kNameColumn = 34, kTextColumn = 84;

void wrap_help(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    option->description(wrapped(option->get_description(), kTextColumn));
  for (CLI::App* verb : app.get_subcommands({})) wrap_help(*verb);
}

// The advice to call the help of the command that was typed.
std::string help_to_call(const CLI::App& app) {
  std::string verb;
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) {
    at = at->get_subcommands().front();
    verb += " " + at->get_name();
  }
  return fmt::format("See `cei3d{} -h`.", verb);
}

// Runs the command; turns an exception into a message and an exit code. Messages name what is wrong in plain
// words, because the editor shows them, too; the options of these names are in the help.
template <class F>
int guarded(const CLI::App& app, Console& console, F run) {
  try {
    run();
    return 0;
  } catch (const Error& e) {
    const bool helpless = e.code() == ErrorCode::usage && e.hint().empty();
    console.error(e.what(), helpless ? help_to_call(app) : e.hint(), int(e.code()));
    return int(e.code());
  } catch (const std::bad_alloc&) {
    console.error(
        "Out of memory. Close other programs, or use fewer or smaller images (--views, --downscale).", "", 1);
  } catch (const std::exception& e) {
    console.error(e.what(), "", 1);
  }
  return 1;
}

// Names the project in the usage line of the commands of `edit`.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
    const CLI::App* parent = app->get_parent();
    if (parent != nullptr && parent->get_name() == "edit") name = "cei3d edit PROJECT " + app->get_name();
    return CLI::Formatter::make_usage(app, name);
  }
};

bool is_command(CLI::App& app, const std::string& name) {
  return !app.get_subcommands([&](CLI::App* command) { return command->get_name() == name; }).empty();
}

using Words = std::vector<std::string>;

// Reads the command line. Returns the exit code where nothing is left to do.
std::optional<int> read_line(CLI::App& app, const Words& words, Console& console, std::ostream& out,
                             std::ostream& err) {
  console.set_json(std::find(words.begin(), words.end(), "--json") != words.end());
  if (!words.empty() && !words[0].starts_with('-') && !is_command(app, words[0])) {
    console.error(fmt::format("There is no command '{}'", words[0]), "See `cei3d -h`.", 2);
    return 2;
  }
  try {
    Words reversed(words.rbegin(), words.rend());  // CLI11 takes them in reverse
    app.parse(reversed);
  } catch (const CLI::Success& e) {  // help, version
    return app.exit(e, out, err);
  } catch (const CLI::ParseError& e) {
    console.error(e.what(), help_to_call(app), 2);
    return 2;
  } catch (const Error& e) {
    console.error(e.what(), e.hint(), int(e.code()));
    return int(e.code());
  }
  return {};
}

}  // namespace

int run_cli(const std::vector<std::string>& args, std::ostream& out, std::ostream& err,
            bool err_is_terminal) {
  CommonOptions common;
  CLI::App app(kAbout, "cei3d");
  app.footer(kCommandFooter);  // commands inherit it
  app.formatter(std::make_shared<HelpFormatter>());
  app.get_formatter()->column_width(kNameColumn);
  add_common(app, common);
  app.require_subcommand(0, 1);
  Commands commands(app, common, [&](const std::vector<std::string>& line) {
    std::ostringstream unseen;
    return run_cli(with_common(line, common), common.json ? unseen : out, err, err_is_terminal);
  });
  for (const auto add :
       {add_check, add_capture, add_reconstruct, add_render, add_edit, add_parts, add_history, add_export,
        add_eval, add_evaluate, add_info, add_bench, add_synth, add_open, add_batch, add_demo, add_manual})
    add(commands);
  app.footer(footer());
  wrap_help(app);

  Console console(out, err, err_is_terminal);
  if (const std::optional<int> code = read_line(app, args, console, out, err)) return *code;
  console.set_json(common.json);
  console.set_level(level_of(common));
  if (!commands.chosen()) {
    err << app.help();
    return 2;
  }
  return guarded(app, console, [&] { commands.run(console); });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// log, undo, redo, toggle, replay.
#include "apps/cli/command.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, id, on;
};

std::string state_of(const LogEntry& e) { return !e.done ? "undone" : e.enabled ? "on" : "off"; }

// "128,96" of a pixel or a point; empty for lists of lists and the like.
std::string numbers_text(const Json& list) {
  std::string text;
  for (const Json& j : list) {
    if (!j.is_number()) return "";
    text += fmt::format("{}{:.6g}", text.empty() ? "" : ",", j.get<double>());
  }
  return text;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_structured() ? numbers_text(value) : value.dump();
}

// The edit's parameters: "part ear, roughness 0.5".
std::string what_of(const LogEntry& e) {
  std::string text;
  for (const auto& [key, value] : e.params.items()) {
    const std::string shown = key == "seed" ? "" : value_text(value);
    if (!shown.empty()) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, shown);
  }
  return text;
}

std::string log_text(const std::vector<LogEntry>& entries) {
  if (entries.empty()) return "No edits.";
  std::string text;
  for (const LogEntry& e : entries) text += fmt::format("{:<20} {:<7} {}\n", e.id, state_of(e), what_of(e));
  return text;
}

void show_log(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::read);
  const std::vector<LogEntry> entries = session.log();
  Json list = Json::array();
  for (const LogEntry& e : entries) list.push_back(e.json());
  console.answer({{"edits", list}}, log_text(entries));
}

void undo(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  const std::string id = session.undo(console);
  console.done({{"undone", id}}, id + " was undone; `cei3d redo` does it again.");
}

void redo(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  const std::string id = session.redo(console);
  console.done({{"redone", id}}, id + " was done again.");
}

void toggle(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  const bool enabled = session.toggle(o.id, console);
  console.done({{"id", o.id}, {"enabled", enabled}}, fmt::format("{} is {}.", o.id, enabled ? "on" : "off"));
}

void replay(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::read);
  const ReplayReport r = session.replay(o.on, console);
  std::string text = fmt::format("Made {} edits of {} on {}.", r.edits.size(), o.project, o.on);
  for (const auto& [from, to] : r.edits) text += fmt::format("\n{:<20} as {}", from, to);
  for (const std::string& note : r.notes) console.warn(note);
  console.done(r.json(), text);
}

template <class F>
CLI::App* add_verb(Commands& commands, const char* name, const char* help, F run) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(name, help);
  verb->add_option("project", o->project, "Project folder")->required();
  if (std::string(name) == "toggle")
    verb->add_option("id", o->id, "Id of the edit, as `log` lists it")->required();
  if (std::string(name) == "replay")
    verb->add_option("--on", o->on,
                     "Project to make the edits on: another reconstruction of the same capture")
        ->required();
  commands.on(verb, o, run);
  return verb;
}

}  // namespace

void add_history(Commands& commands) {
  add_verb(commands, "log", "List the edits, oldest first, as on, off or undone", show_log);
  add_verb(commands, "undo", "Undo the last edit", undo);
  add_verb(commands, "redo", "Redo the last undone edit", redo);
  add_verb(commands, "toggle", "Switch one edit off or on; later edits stay", toggle);
  add_verb(commands, "replay", "Make the edits of a project on another project", replay);
}

}  // namespace cei3d

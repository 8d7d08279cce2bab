// SPDX-License-Identifier: Apache-2.0
// log, undo, redo, toggle, goto, rename, restore, forget, replay.
#include "apps/cli/command.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, id, on, name;
  size_t done = 0;
};

std::string state_of(const LogEntry& e) {
  if (e.set_aside) return "aside";
  return !e.done ? "undone" : e.enabled ? "on" : "off";
}

// A pixel or a point as "128,96"; empty if the list holds anything but numbers.
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

// The name of the edit and its parameters: "part ear, roughness 0.5".
std::string what_of(const LogEntry& e) {
  std::string text = e.name.empty() ? "" : '"' + e.name + '"';
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

void go_to(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  session.go_to(o.done, console);
  console.done({{"done", o.done}}, fmt::format("The first {} edits are done.", o.done));
}

void rename(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  session.rename(o.id, o.name);
  console.done({{"id", o.id}, {"name", o.name}}, fmt::format("{} is called '{}'.", o.id, o.name));
}

void restore(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  session.restore(o.id, console);
  console.done({{"restored", o.id}}, fmt::format("{} and what was set aside with it are done again.", o.id));
}

void forget(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::write);
  session.forget_set_aside();
  console.done(Json::object(), "What was set aside is gone.");
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
  const std::string verb_name = name;
  if (verb_name == "toggle" || verb_name == "rename" || verb_name == "restore")
    verb->add_option("id", o->id, "Id of the edit, as `log` lists it")->required();
  if (verb_name == "rename") verb->add_option("name", o->name, "Its new name; '' for none")->required();
  if (verb_name == "goto")
    verb->add_option("done", o->done, "Number of edits to keep active, from the first on; 0: none")
        ->required();
  if (verb_name == "replay")
    verb->add_option("--on", o->on,
                     "Project to make the edits on: another reconstruction of the same capture")
        ->required();
  commands.on(verb, o, run);
  return verb;
}

}  // namespace

void add_history(Commands& commands) {
  add_verb(commands, "log", "List the edits, oldest first, as on, off, undone or set aside", show_log);
  add_verb(commands, "undo", "Undo the last edit", undo);
  add_verb(commands, "redo", "Redo the last undone edit", redo);
  add_verb(commands, "toggle", "Switch one edit off or on; later edits stay", toggle);
  add_verb(commands, "goto", "Undo or redo up to a step of the history", go_to);
  add_verb(commands, "rename", "Name an edit", rename);
  add_verb(commands, "restore", "Bring back edits that a later one displaced; those in their place go aside",
           restore);
  add_verb(commands, "forget", "Remove what was set aside, for good", forget);
  add_verb(commands, "replay", "Make the edits of a project on another project", replay);
}

}  // namespace cei3d

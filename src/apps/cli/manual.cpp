// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/manual.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "core/base/error.h"

namespace cei3d {
namespace {

// Text for troff: hyphens stay hyphens when they are copied, and no line begins a request.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  return text;
}

// Lines as they are.
std::string verbatim(const std::string& text) {
  std::istringstream in(text);
  std::string out = ".nf\n";
  for (std::string line; std::getline(in, line);) out += escaped(line) + "\n";
  return out + ".fi\n";
}

// "-o, --output TEXT (required)"
std::string heading(const OptionNode& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) names.push_back(bold(name));
  std::string out = joined(names, ", ");
  const std::string value = option.choices.empty() ? option.value : joined(option.choices, "|");
  if (!value.empty()) out += option.optional_value ? " [" + italic(value) + "]" : " " + italic(value);
  if (option.required) out += " (required)";
  return out;
}

std::string entry(const OptionNode& option) {
  std::string out = ".TP\n" + heading(option) + "\n" + escaped(option.help);
  if (!option.default_value.empty()) out += " [" + escaped(option.default_value) + "]";
  return out + (out.ends_with('.') ? "\n" : ".\n");
}

std::string arguments(const CommandNode& command) {
  std::string out;
  for (const OptionNode& p : command.positionals)
    out += p.required ? " " + italic(upper(p.names[0])) : " [" + italic(upper(p.names[0])) + "]";
  return out;
}

// "cei3d edit PROJECT paint [OPTIONS]": a command stands behind the arguments of the one that it belongs to.
std::string synopsis(const CommandNode& program, const CommandNode& command) {
  std::string out = bold("cei3d");
  const CommandNode* at = &program;
  for (const std::string& word : command.path) {
    at = &*std::find_if(at->commands.begin(), at->commands.end(),
                        [&](const CommandNode& below) { return below.path.back() == word; });
    out += " " + bold(word) + arguments(*at);
  }
  if (!at->options.empty()) out += " [" + italic("OPTIONS") + "]";
  return out + (at->commands.empty() ? "" : " " + italic("COMMAND"));
}

std::string section(const CommandNode& program, const CommandNode& command) {
  std::string out = ".SS " + escaped(command.name()) + "\n" + synopsis(program, command) + "\n.PP\n" +
                    escaped(command.help) + ".\n";
  for (const OptionNode& option : command.positionals) {
    OptionNode shown = option;
    shown.names[0] = upper(shown.names[0]);
    shown.value.clear();
    out += entry(shown);
  }
  for (const OptionNode& option : command.options)
    if (option.names.front() != "-h") out += entry(option);
  return out;
}

}  // namespace

std::string manual_page(const CommandNode& program, const std::string& footer, const std::string& version) {
  const size_t line_end = program.help.find('\n'), name_end = program.help.find(": ") + 2;
  std::string out = ".\\\" Written by `cei3d manual`.\n";
  out += fmt::format(".TH CEI3D 1 \"\" \"cei3d {}\" \"User Commands\"\n", version);
  out += ".SH NAME\ncei3d \\- " + escaped(program.help.substr(name_end, line_end - name_end)) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(program, program) + "\n";
  out += ".SH DESCRIPTION\n" + verbatim(program.help.substr(program.help.find_first_not_of('\n', line_end)));
  out += ".SH OPTIONS\nOf every command:\n";
  for (const OptionNode& option : program.options) out += entry(option);
  out += ".SH COMMANDS\n";
  for (const CommandNode* command : all_commands(program))
    if (command != &program) out += section(program, *command);
  return out + ".SH NOTES\n" + verbatim(footer);
}

}  // namespace cei3d

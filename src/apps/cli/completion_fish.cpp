// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/completion.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

// __cei3d_at COMMAND: whether the words before the cursor lead to this command.
constexpr const char* kFunction = R"fish(function __cei3d_at
    set -l at
    for word in (commandline -opc)[2..]
        if contains -- $word (__cei3d_commands "$at")
            set -a at $word
        end
    end
    test "$at" = "$argv"
end
)fish";

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return out + "'";
}

// The flags of `complete` for the value of an option: -r: it has one; -x: it has one, which is not a file.
std::string values(const OptionNode& option) {
  if (option.kind == ValueKind::none || option.optional_value) return "";
  if (option.kind == ValueKind::choice) return " -xa " + quoted(joined(option.choices, " "));
  if (option.kind == ValueKind::folder) return " -xa '(__fish_complete_directories)'";
  return option.kind == ValueKind::number ? " -x" : " -rF";
}

std::string line(const std::string& condition, const OptionNode& option) {
  std::string out = "complete -c cei3d" + condition;
  for (const std::string& name : option.names)
    out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return out + values(option) + " -d " + quoted(first_sentence(option.help)) + "\n";
}

std::string table(const CommandNode& program) {
  std::string out = "function __cei3d_commands\n    switch \"$argv\"\n";
  for (const CommandNode* command : all_commands(program)) {
    std::vector<std::string> names;
    for (const CommandNode& c : command->commands) names.push_back(c.path.back());
    if (!names.empty())
      out += fmt::format("        case {}\n            string split ' ' {}\n", quoted(command->name()),
                         quoted(joined(names, " ")));
  }
  return out + "    end\nend\n";
}

}  // namespace

std::string fish_completion(const CommandNode& program) {
  std::string out =
      "# Completion of cei3d in fish. Written by `cei3d completion fish`.\n" + table(program) + kFunction;
  for (const OptionNode& option : program.options) out += line("", option);
  for (const CommandNode* command : all_commands(program)) {
    const std::string condition = " -n " + quoted("__cei3d_at " + command->name());
    if (command->positionals.empty() && !command->commands.empty())
      out += "complete -c cei3d -f" + condition + "\n";
    for (const CommandNode& c : command->commands)
      out += "complete -c cei3d" + condition + " -a " + c.path.back() + " -d " +
             quoted(first_sentence(c.help)) + "\n";
    if (command != &program)
      for (const OptionNode& option : command->options) out += line(condition, option);
  }
  return out;
}

}  // namespace cei3d

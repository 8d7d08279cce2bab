// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "apps/cli/completion.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

std::string replaced(const std::string& text, const std::string& characters) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += (characters.find(c) == characters.npos ? "" : "\\") + std::string(1, c);
  }
  return out;
}

std::string function_name(const CommandNode& command) {
  return command.path.empty() ? "_cei3d" : "_cei3d_" + joined(command.path, "_");
}

std::string action(const OptionNode& option) {
  if (option.kind == ValueKind::number) return " ";
  if (option.kind == ValueKind::folder) return "_files -/";
  if (option.kind != ValueKind::choice) return "_files";
  return "(" + joined(option.choices, " ") + ")";
}

// A specification of _arguments: '(-o --output)'{-o,--output}'[help]:TEXT:_files'
std::string specification(const OptionNode& option) {
  std::string out = option.repeatable ? "'*'" : fmt::format("'({})'", joined(option.names, " "));
  out += option.names.size() > 1 ? "{" + joined(option.names, ",") + "}" : option.names[0];
  out += fmt::format("'[{}]", replaced(first_sentence(option.help), "[]\\:"));
  if (option.kind != ValueKind::none)
    out += fmt::format("{}{}:{}", option.optional_value ? "::" : ":", option.value, action(option));
  return out + "'";
}

// Whether an option of the program goes with the command, which has no option of that name itself.
bool is_common(const OptionNode& option, const CommandNode& command) {
  const std::string& name = option.names.back();
  return name != "--version" && std::none_of(command.options.begin(), command.options.end(),
                                             [&](const OptionNode& o) { return o.names.back() == name; });
}

std::string arguments(const CommandNode& program, const CommandNode& command) {
  std::string out;
  for (const OptionNode& option : command.options) out += " \\\n    " + specification(option);
  if (&command != &program)
    for (const OptionNode& option : program.options)
      if (is_common(option, command)) out += " \\\n    " + specification(option);
  size_t place = 0;
  for (const OptionNode& p : command.positionals)
    out += p.repeatable ? fmt::format(" \\\n    '*:{}:{}'", p.names[0], action(p))
                        : fmt::format(" \\\n    '{}:{}:{}'", ++place, p.names[0], action(p));
  if (!command.commands.empty())
    out += fmt::format(" \\\n    '{}:command:{}_commands' \\\n    '*::: :->below'", ++place,
                       function_name(command));
  return out;
}

// The function of a command with subcommands; it calls the function of the one that was typed.
std::string dispatch(const CommandNode& command) {
  std::string out = fmt::format(
      "  [[ $state == below ]] || return\n  local below=$line[{}]\n  words=($below $words)\n  (( ++CURRENT "
      "))\n"
      "  case $below in\n",
      command.positionals.size() + 1);
  for (const CommandNode& c : command.commands)
    out += fmt::format("    {}) {} ;;\n", c.path.back(), function_name(c));
  return out + "  esac\n";
}

std::string list_of(const CommandNode& command) {
  std::string out = function_name(command) + "_commands() {\n  local -a list=(\n";
  for (const CommandNode& c : command.commands)
    out += fmt::format("    '{}:{}'\n", c.path.back(), replaced(first_sentence(c.help), ""));
  return out + "  )\n  _describe command list\n}\n";
}

}  // namespace

std::string zsh_completion(const CommandNode& program) {
  std::string out = "#compdef cei3d\n# Completion of cei3d in zsh. Written by `cei3d completion zsh`.\n";
  for (const CommandNode* command : all_commands(program)) {
    const bool branches = !command->commands.empty();
    if (branches) out += list_of(*command);
    out += function_name(*command) + "() {\n";
    if (branches) out += "  local context state state_descr line\n  typeset -A opt_args\n";
    out += std::string("  _arguments ") + (branches ? "-C -s" : "-s") + arguments(program, *command) + "\n";
    if (branches) out += dispatch(*command);
    out += "}\n";
  }
  // Read by a file that calls it, or loaded as a function of this name.
  return out + "if [[ $funcstack[1] == _cei3d ]]; then _cei3d \"$@\"; else compdef _cei3d cei3d; fi\n";
}

}  // namespace cei3d

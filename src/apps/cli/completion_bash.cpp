// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/completion.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

// The function that completes: it finds the command in the words before the cursor, and takes the candidates
// from three tables by command. Bash makes separate words of `=` and `:`.
constexpr const char* kFunction = R"sh(
_cei3d() {
  local command='' taking='' word kinds i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word == '=' ]]; then
      continue
    elif [[ -n $taking ]]; then
      taking=''
    elif [[ $word == -* ]]; then
      if [[ -n $(_cei3d_values "$command" "$word") ]]; then taking=$word; fi
    elif [[ " $(_cei3d_commands "$command") " == *" $word "* ]]; then
      command+=${command:+ }$word
    fi
  done
  word=${COMP_WORDS[COMP_CWORD]}
  [[ $word != '=' ]] || word=''
  if [[ -n $taking ]]; then
    kinds=$(_cei3d_values "$command" "$taking")
  elif [[ $word == -* ]]; then
    kinds="$(_cei3d_options "$command") $(_cei3d_options '')"
  else
    kinds="$(_cei3d_commands "$command") $(_cei3d_values "$command" argument)"
  fi
  _cei3d_reply "$word" "$kinds"
}

# WORD KINDS: KINDS are words to choose from, or @file, @folder, @number for values that cannot be listed here.
_cei3d_reply() {
  mapfile -t COMPREPLY < <(compgen -W "${2//@*/}" -- "$1")
  case $2 in
    *@file*) _cei3d_paths -f "$1" ;;
    *@folder*) _cei3d_paths -d "$1" ;;
  esac
}

_cei3d_paths() {
  compopt -o filenames 2>/dev/null
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen "$1" -- "$2")
}

complete -F _cei3d cei3d
)sh";

std::string words_of(const OptionNode& option) {
  if (option.kind == ValueKind::number) return "@number";
  if (option.kind == ValueKind::folder) return "@folder";
  return option.kind == ValueKind::choice ? joined(option.choices, " ") : "@file";
}

std::string names_of(const std::vector<OptionNode>& options) {
  std::vector<std::string> names;
  for (const OptionNode& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return joined(names, " ");
}

// One line of a table: the words for a key.
std::string line(const std::string& key, const std::string& words) {
  return words.empty() ? "" : fmt::format("    '{}') echo '{}' ;;\n", key, words);
}

std::string values_of(const CommandNode& command) {
  std::string out;
  for (const OptionNode& option : command.options)
    if (option.kind != ValueKind::none && !option.optional_value)
      for (const std::string& name : option.names) out += line(command.name() + " " + name, words_of(option));
  if (!command.positionals.empty())
    out += line(command.name() + " argument", words_of(command.positionals.front()));
  return out;
}

}  // namespace

std::string bash_completion(const CommandNode& program) {
  std::string commands, options, values;
  for (const CommandNode* command : all_commands(program)) {
    std::vector<std::string> below;
    for (const CommandNode& c : command->commands) below.push_back(c.path.back());
    commands += line(command->name(), joined(below, " "));
    options += line(command->name(), names_of(command->options));
    if (command != &program) values += values_of(*command);
  }
  // Options of every command.
  std::string common;
  for (const OptionNode& option : program.options)
    if (option.kind != ValueKind::none)
      for (const std::string& name : option.names)
        common += fmt::format("    *' {}') echo '{}' ;;\n", name, words_of(option));
  return "# Completion of cei3d in bash. Written by `cei3d completion bash`.\n"
         "_cei3d_commands() {\n  case $1 in\n" +
         commands +
         "  esac\n}\n"
         "_cei3d_options() {\n  case $1 in\n" +
         options +
         "  esac\n}\n"
         "_cei3d_values() {\n  case \"$1 $2\" in\n" +
         values + common + "  esac\n}\n" + kFunction;
}

}  // namespace cei3d

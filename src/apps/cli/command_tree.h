// SPDX-License-Identifier: Apache-2.0
// The commands and options of the program as plain data, from which the manual page and the completions of
// shells are written.
#pragma once

#include <string>
#include <vector>

#include "apps/cli/command.h"

namespace cei3d {

enum class ValueKind { none, text, number, file, folder, choice };  // none: a flag

struct OptionNode {
  std::vector<std::string> names;  // "-o", "--output"; of a positional argument its one name
  ValueKind kind = ValueKind::text;
  std::string value;  // what it takes, in capitals: "TEXT", "INT"; empty: a flag
  std::vector<std::string> choices;
  std::string default_value;
  bool required = false, optional_value = false, repeatable = false;
  std::string help;  // one line
};

struct CommandNode {
  std::vector<std::string> path;  // {"edit", "paint"}; empty: the program
  std::string help;
  std::vector<OptionNode> positionals, options;
  std::vector<CommandNode> commands;
  std::string name() const;  // "edit paint"
};

// Leaves out what the help hides. Options that every command has are listed for the program only.
CommandNode command_tree(const CLI::App&);

// The node, then all below it, in the order of the help.
std::vector<const CommandNode*> all_commands(const CommandNode&);

std::string joined(const std::vector<std::string>& words, const std::string& between);
std::string first_sentence(const std::string& help);

}  // namespace cei3d

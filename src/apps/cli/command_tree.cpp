// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command_tree.h"

#include <sstream>

namespace cei3d {
namespace {

std::string one_line(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string word; in >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

// The choices in "TEXT:{a,b}", as CLI11 describes them.
std::vector<std::string> choices_of(const std::string& type) {
  const size_t begin = type.find('{'), end = type.rfind('}');
  std::vector<std::string> out;
  if (begin == type.npos || end == type.npos) return out;
  std::istringstream in(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(in, choice, ',');) out.push_back(choice);
  return out;
}

ValueKind kind_of(const CLI::Option& option, const std::string& type) {
  if (option.get_items_expected_max() == 0) return ValueKind::none;
  if (type.find('{') != type.npos) return ValueKind::choice;
  if (type.find(":DIR") != type.npos) return ValueKind::folder;
  if (type.find(":FILE") != type.npos || type.find(":PATH") != type.npos) return ValueKind::file;
  return type.starts_with("TEXT") ? ValueKind::text : ValueKind::number;
}

OptionNode node_of(const CLI::Option& option) {
  OptionNode node;
  const std::string type = option.get_type_name();
  if (option.get_positional()) node.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) node.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) node.names.push_back("--" + name);
  node.kind = kind_of(option, type);
  if (node.kind != ValueKind::none) node.value = type.substr(0, type.find(':'));
  node.choices = choices_of(type);
  node.default_value = option.get_default_str();
  node.required = option.get_required() || option.get_option_text().ends_with("REQUIRED");
  node.optional_value = node.kind != ValueKind::none && option.get_items_expected_min() == 0;
  node.repeatable = option.get_expected_max() >= CLI::detail::expected_max_vector_size ||
                    option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  node.help = one_line(option.get_description());
  return node;
}

CommandNode node_of(const CLI::App& app, std::vector<std::string> path) {
  CommandNode node{std::move(path), app.get_description(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; }))
    if (!option->get_group().empty())
      (option->get_positional() ? node.positionals : node.options).push_back(node_of(*option));
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    std::vector<std::string> below = node.path;
    below.push_back(command->get_name());
    node.commands.push_back(node_of(*command, std::move(below)));
  }
  return node;
}

}  // namespace

std::string CommandNode::name() const { return joined(path, " "); }

CommandNode command_tree(const CLI::App& app) { return node_of(app, {}); }

std::vector<const CommandNode*> all_commands(const CommandNode& node) {
  std::vector<const CommandNode*> out = {&node};
  for (const CommandNode& command : node.commands)
    for (const CommandNode* below : all_commands(command)) out.push_back(below);
  return out;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

std::string first_sentence(const std::string& help) {
  const size_t end = help.find(". ");
  return end == help.npos ? help : help.substr(0, end);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The manual page and the completions of shells name every command and option that the help names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "apps/cli/cli.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

std::string typed(const Words& args) {
  std::ostringstream out, err;
  EXPECT_EQ(run_cli(args, out, err, false), 0) << err.str();
  return out.str();
}

std::string help_of(Words path) {
  path.push_back("-h");
  return typed(path);
}

// First words of the lines of the help that begin with two spaces and a word.
Words first_words(const std::string& help) {
  std::istringstream in(help);
  Words out;
  for (std::string line; std::getline(in, line);)
    if (line.size() > 2 && line.starts_with("  ") && line[2] != ' ')
      out.push_back(line.substr(2, line.find(' ', 2) - 2));
  return out;
}

// Every name of every option.
Words options_in(const std::string& help) {
  Words out;
  for (const std::string& word : first_words(help)) {
    std::istringstream names(word);
    if (word.starts_with('-'))
      for (std::string name; std::getline(names, name, ',');) out.push_back(name);
  }
  return out;
}

Words commands_in(std::string help) {
  const std::string heading = "\nSubcommands:\n";
  const size_t begin = help.find(heading);
  return begin == help.npos ? Words{} : first_words(help.substr(begin, help.find("\n\n", begin + 1) - begin));
}

std::vector<Words> all_paths(const Words& path = {}) {
  std::vector<Words> out = {path};
  for (const std::string& command : commands_in(help_of(path))) {
    Words below = path;
    below.push_back(command);
    const auto more = all_paths(below);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

std::string joined(const Words& words, const char* between) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

// From the first mark to the second one behind it.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const size_t at = text.find(begin);
  EXPECT_NE(at, text.npos) << begin;
  return at == text.npos ? "" : text.substr(at, text.find(end, at + begin.size()) - at);
}

std::string bash_words(const std::string& script, const std::string& table, const std::string& key) {
  return between(between(script, table + "() {", "\n}\n"), "    '" + key + "') echo '", "' ;;") + " ";
}

std::string hyphens(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '-' ? "\\-" : std::string(1, c);
  return out;
}

TEST(WrittenUsage, HelpHasTheCommandsThatThisTestIsAbout) {
  const std::vector<Words> paths = all_paths();
  for (const Words& path : {Words{"reconstruct"}, {"edit", "paint"}, {"batch", "work"}})
    EXPECT_NE(std::find(paths.begin(), paths.end(), path), paths.end()) << joined(path, " ");
  EXPECT_THAT(options_in(help_of({"edit", "paint"})),
              ::testing::IsSupersetOf({"-h", "--help", "--scribble"}));
}

TEST(WrittenUsage, ManualNamesEveryOptionOfEveryCommand) {
  const std::string page = typed({"manual"});
  for (const Words& path : all_paths()) {
    const std::string section = path.empty() ? between(page, ".SH OPTIONS\n", "\n.SH ")
                                             : between(page, ".SS " + joined(path, " ") + "\n", "\n.S");
    for (const std::string& option : options_in(help_of(path))) {
      if (!path.empty() && (option == "-h" || option == "--help")) continue;
      EXPECT_THAT(section, HasSubstr("\\fB" + hyphens(option) + "\\fR")) << joined(path, " ");
    }
  }
}

TEST(WrittenUsage, BashCompletesEveryOptionOfEveryCommand) {
  const std::string script = typed({"completion", "bash"});
  for (const Words& path : all_paths()) {
    const std::string help = help_of(path), key = joined(path, " ");
    for (const std::string& option : options_in(help))
      EXPECT_THAT(bash_words(script, "_cei3d_options", key),
                  AnyOf(HasSubstr(" " + option + " "), HasSubstr("'" + option + " ")))
          << key;
    for (const std::string& command : commands_in(help))
      EXPECT_THAT(bash_words(script, "_cei3d_commands", key),
                  AnyOf(HasSubstr(" " + command + " "), HasSubstr("'" + command + " ")))
          << key;
  }
}

TEST(WrittenUsage, ZshCompletesEveryOptionOfEveryCommand) {
  const std::string script = typed({"completion", "zsh"});
  for (const Words& path : all_paths()) {
    const std::string help = help_of(path), name = joined(path, "_");
    const std::string function = "_cei3d" + (name.empty() ? "" : "_" + name);
    const std::string body = between(script, "\n" + function + "() {", "\n}\n");
    for (const std::string& option : options_in(help))
      EXPECT_THAT(body, AnyOf(HasSubstr("'" + option + "'["), HasSubstr("{" + option + ","),
                              HasSubstr("," + option + "}"), HasSubstr(")'" + option + "'[")))
          << function;
    for (const std::string& command : commands_in(help))
      EXPECT_THAT(script, HasSubstr("    '" + command + ":")) << function;
  }
}

TEST(WrittenUsage, FishCompletesEveryOptionOfEveryCommand) {
  const std::string script = typed({"completion", "fish"});
  for (const Words& path : all_paths()) {
    const std::string help = help_of(path);
    const std::string start = "\ncomplete -c cei3d -n '__cei3d_at " + joined(path, " ") + "'";
    for (const std::string& option : options_in(help)) {
      const bool common = path.empty();
      const std::string flag =
          option.starts_with("--") ? " -l " + option.substr(2) : " -s " + option.substr(1);
      bool found = false;
      for (size_t at = script.find(common ? "\ncomplete -c cei3d" : start); at != script.npos && !found;
           at = script.find(common ? "\ncomplete -c cei3d" : start, at + 1))
        found = script.substr(at + 1, script.find('\n', at + 1) - at).find(flag + " ") != script.npos;
      EXPECT_TRUE(found) << joined(path, " ") << " " << option;
    }
    for (const std::string& command : commands_in(help))
      EXPECT_THAT(script, HasSubstr(start + " -a " + command + " "));
  }
}

TEST(WrittenUsage, NothingHiddenIsShown) {
  for (const Words& line :
       {Words{"manual"}, {"completion", "bash"}, {"completion", "zsh"}, {"completion", "fish"}})
    EXPECT_THAT(typed(line), Not(AnyOf(HasSubstr("--app"), HasSubstr("\\-\\-app"), HasSubstr("-l app"))))
        << line.back();
}

TEST(WrittenUsage, IsJsonWhenAsked) {
  EXPECT_EQ(Json::parse(typed({"manual", "--json"})).at("page"), typed({"manual"}));
  EXPECT_EQ(Json::parse(typed({"completion", "zsh", "--json"})).at("script"), typed({"completion", "zsh"}));
}

}  // namespace
}  // namespace cei3d

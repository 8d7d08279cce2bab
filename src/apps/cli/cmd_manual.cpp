// SPDX-License-Identifier: Apache-2.0
// manual, completion.
#include "apps/cli/completion.h"
#include "apps/cli/manual.h"
#include "core/base/json.h"
#include "engine/session/version.h"

namespace cei3d {
namespace {

struct Options {
  std::string shell;
};

std::string completion(const std::string& shell, const CommandNode& program) {
  if (shell == "bash") return bash_completion(program);
  return shell == "zsh" ? zsh_completion(program) : fish_completion(program);
}

}  // namespace

void add_manual(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("completion", "Print the completion of the command line for a shell");
  verb->add_option("shell", o->shell, "To try: source <(cei3d completion bash)")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  commands.on(verb, o, [&commands](const Options& options, Session&, Console& console) {
    const std::string script = completion(options.shell, command_tree(commands.app()));
    console.answer({{"script", script}}, script);
  });
  verb = commands.add("manual", "Print the manual page; to read it: cei3d manual | man -l -");
  commands.on(verb, std::make_shared<Options>(), [&commands](const Options&, Session&, Console& console) {
    const CLI::App& app = commands.app();
    const std::string page = manual_page(command_tree(app), app.get_footer(), kVersion);
    console.answer({{"page", page}}, page);
  });
}

}  // namespace cei3d

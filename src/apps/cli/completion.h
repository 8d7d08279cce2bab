// SPDX-License-Identifier: Apache-2.0
// Completion of the command line in shells, as scripts that they read.
#pragma once

#include <string>

#include "apps/cli/command_tree.h"

namespace cei3d {

std::string bash_completion(const CommandNode& program);
std::string zsh_completion(const CommandNode& program);
std::string fish_completion(const CommandNode& program);

}  // namespace cei3d

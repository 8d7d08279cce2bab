// SPDX-License-Identifier: Apache-2.0
// The manual page of the program, in the language of man(7).
#pragma once

#include <string>

#include "apps/cli/command_tree.h"

namespace cei3d {

// program: its help is the name and one sentence, then examples. footer: the text at the end of the help.
std::string manual_page(const CommandNode& program, const std::string& footer, const std::string& version);

}  // namespace cei3d

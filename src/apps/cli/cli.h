// SPDX-License-Identifier: Apache-2.0
// The command line as a function, so that tests can type commands.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace cei3d {

// args: without the program's name. Results go to `out`, everything else to `err`. err_is_terminal: progress
// is drawn as a bar. Returns the exit code: 0 done, 1 failed, 2 wrong usage, 130 interrupted and saved.
int run_cli(const std::vector<std::string>& args, std::ostream& out, std::ostream& err, bool err_is_terminal);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM as a question that a running command asks now and then.
#pragma once

namespace cei3d {

// After this call Ctrl-C and SIGTERM ask the running command to save and stop; a second one ends the program
// immediately.
void catch_interrupts();
bool interrupted();

}  // namespace cei3d

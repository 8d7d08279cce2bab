// SPDX-License-Identifier: Apache-2.0
// Catches Ctrl-C and SIGTERM, so that a running command can ask whether one has come.
#pragma once

namespace cei3d {

// After this call Ctrl-C and SIGTERM ask the running command to save and stop; a second one ends the program
// immediately.
void catch_interrupts();
bool interrupted();

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// From now on Ctrl-C and SIGTERM ask the running work to save and stop; the second one ends the program at
// once.
void catch_interrupts();
bool interrupted();

}  // namespace cei3d

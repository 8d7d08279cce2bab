// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <iostream>

#include "apps/cli/cli.h"
#include "apps/cli/interrupt.h"

int main(int argc, char** argv) {
  cei3d::catch_interrupts();
  return cei3d::run_cli({argv + 1, argv + argc}, std::cout, std::cerr, ::isatty(STDERR_FILENO) != 0);
}

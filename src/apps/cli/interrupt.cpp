// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace cei3d {
namespace {

volatile std::sig_atomic_t asked = 0;  // a signal handler can reach nothing but a global

void on_signal(int) {
  if (asked) ::_exit(130);
  asked = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // files being written are not cut short
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return asked != 0; }

}  // namespace cei3d

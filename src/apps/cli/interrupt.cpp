// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace cei3d {
namespace {

std::atomic<bool> asked = false;  // a signal handler can reach nothing but a global
static_assert(std::atomic<bool>::is_always_lock_free, "locks are not for signal handlers");

void on_signal(int) {
  if (asked.exchange(true)) ::_exit(130);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // files being written are not cut short
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return asked; }

}  // namespace cei3d

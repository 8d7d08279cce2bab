// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>

namespace cei3d {

void parallel_ranges(int n, int grain, const std::function<void(int, int)>& body) {
  const int chunks = (n + grain - 1) / grain;
  parallel_for(chunks, [&](int c) { body(c * grain, std::min(n, (c + 1) * grain)); });
}

struct Threads::Arena {
  tbb::task_arena arena;
};

Threads::Threads(int n)
    : arena_(std::make_unique<Arena>(Arena{tbb::task_arena(n > 0 ? n : tbb::task_arena::automatic)})) {}
Threads::~Threads() = default;

void Threads::enter(const std::function<void()>& work) const { arena_->arena.execute(work); }

}  // namespace cei3d

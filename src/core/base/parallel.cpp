// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <memory>

namespace cei3d {

void parallel_ranges(int n, int grain, const std::function<void(int, int)>& body) {
  const int chunks = (n + grain - 1) / grain;
  parallel_for(chunks, [&](int c) { body(c * grain, std::min(n, (c + 1) * grain)); });
}

void set_threads(int n) {
  static std::unique_ptr<tbb::global_control> control;  // oneTBB's limit lives as long as this object
  control.reset();
  if (n > 0)
    control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, size_t(n));
}

}  // namespace cei3d

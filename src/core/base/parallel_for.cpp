// SPDX-License-Identifier: Apache-2.0
#include <oneapi/tbb/parallel_for.h>

#include "core/base/parallel.h"

namespace cei3d {

void parallel_for(int chunks, const std::function<void(int)>& body) {
  tbb::parallel_for(
      0, chunks, [&](int i) { body(i); }, tbb::simple_partitioner());
}

}  // namespace cei3d

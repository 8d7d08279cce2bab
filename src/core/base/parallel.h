// SPDX-License-Identifier: Apache-2.0
// Threads. Work is cut into chunks whose borders do not depend on the number of threads, so results don't
// either.
#pragma once

#include <functional>

namespace cei3d {

// Calls body(chunk) for chunk in [0, chunks), in any order, on the threads of this process.
void parallel_for(int chunks, const std::function<void(int)>& body);

// Calls body(begin, end) on consecutive ranges of [0, n) of `grain` items (the last may be shorter).
void parallel_ranges(int n, int grain, const std::function<void(int, int)>& body);

// Threads that parallel_for may use from now on; 0: all cores.
void set_threads(int n);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The heap of the CUDA tests: operator new and delete over host memory that the card can reach under the same
// address, so that the tests of the kernels hand their std::vectors to every device alike.
#pragma once

namespace cei3d::cuda {

// From here on `new` takes memory that the card can reach; before, ordinary memory, as CUDA must not be used
// before main(). Error: the card does not offer it.
void open_heap();

}  // namespace cei3d::cuda

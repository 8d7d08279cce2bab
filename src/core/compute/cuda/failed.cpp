// SPDX-License-Identifier: Apache-2.0
#include "core/compute/cuda/failed.h"

#include <cxxabi.h>

#include <cstdlib>
#include <memory>

#include "core/base/error.h"

namespace cei3d::cuda {

void failed(const char* what, const char* why) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> readable(abi::__cxa_demangle(what, nullptr, nullptr, &status),
                                                        std::free);
  fail("CUDA: {}: {}", status == 0 ? readable.get() : what, why);
}

}  // namespace cei3d::cuda

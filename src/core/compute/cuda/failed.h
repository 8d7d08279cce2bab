// SPDX-License-Identifier: Apache-2.0
// Errors of CUDA as errors of the program. Apart from check.h because nvcc does not compile the text
// formatting that core/base/error.h needs.
#pragma once

namespace cei3d::cuda {

// Error "CUDA: <what>: <why>". what: words, or the name() of a type, which is made readable.
[[noreturn]] void failed(const char* what, const char* why);

}  // namespace cei3d::cuda

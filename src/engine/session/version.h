// SPDX-License-Identifier: Apache-2.0
// The version of the program, and of its results.
#pragma once

namespace cei3d {

inline constexpr const char* kVersion = "0.1.0";  // as CMakeLists.txt's project() says

// Raised when a capture and options give another object than before.
inline constexpr int kResultVersion = 1;

}  // namespace cei3d

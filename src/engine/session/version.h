// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

inline constexpr const char* kVersion = "0.1.0";  // as CMakeLists.txt's project() says

}  // namespace cei3d

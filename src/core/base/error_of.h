// SPDX-License-Identifier: Apache-2.0
// For tests: the error that an action ends with.
#pragma once

#include <functional>
#include <string>

#include "core/base/error.h"

namespace cei3d {

inline Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    return e;
  }
  return {ErrorCode::failed, "no error"};
}

inline std::string message(const std::function<void()>& action) { return error_of(action).what(); }

}  // namespace cei3d

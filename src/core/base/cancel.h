// SPDX-License-Identifier: Apache-2.0
// Cancellation: every loop that can take longer than a few seconds calls check_cancelled().
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"

namespace cei3d {

// Throws the interrupted Error (exit code 130) when the user asked to stop. sentence: what was interrupted,
// and what became of it.
inline void check_cancelled(const Progress& progress, const char* sentence = "The work was interrupted.") {
  if (progress.cancelled()) throw Error(ErrorCode::interrupted, sentence);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// How large photographs are used, and what memory a reconstruction of them takes.
#pragma once

#include "engine/capture/check.h"

namespace cei3d {

// N of 1/N, the size at which the training views show at most 60 million pixels of the object together: more
// than a training of an hour on a few cores looks at, and .6 GB.
int default_downscale(const CaptureReport&);

// GiB that a reconstruction takes at most, at 1/downscale of the photographs' size.
double reconstruction_gib(const CaptureReport&, int downscale);

}  // namespace cei3d

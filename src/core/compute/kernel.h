// SPDX-License-Identifier: Apache-2.0
// A kernel is a struct with plain `Args` (pointers and sizes) and `template <class T> static HD void
// run(const Args&, int i)`. Item i is one CUDA thread, or on the CPU the first of W samples in the lanes of
// one register. Forward and gradient stand in the same file; kernels/list.h is the only registry.
#pragma once

#include "core/compute/kernels/list.h"
#include "core/math/scalar.h"

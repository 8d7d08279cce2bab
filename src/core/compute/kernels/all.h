// SPDX-License-Identifier: Apache-2.0
// The definitions of every kernel of kernels/list.h, for the backends, which compile them all. Files that
// launch a kernel include its own header.
#pragma once

#include "core/compute/kernels/activate.h"
#include "core/compute/kernels/adam.h"
#include "core/compute/kernels/encode.h"
#include "core/compute/kernels/field_hit.h"
#include "core/compute/kernels/light.h"
#include "core/compute/kernels/network_gradient.h"
#include "core/compute/kernels/radiance.h"
#include "core/compute/kernels/shade.h"
#include "core/compute/kernels/single_sg.h"

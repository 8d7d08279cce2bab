// SPDX-License-Identifier: Apache-2.0
// The one list of kernels. Adding one touches no backend.
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/activate.h"
#include "core/compute/kernels/adam.h"
#include "core/compute/kernels/encode.h"
#include "core/compute/kernels/light.h"
#include "core/compute/kernels/radiance.h"
#include "core/compute/kernels/shade.h"

namespace cei3d {

using AllKernels =
    KernelList<EncodePoint, EncodeFrequency, EncodeGrid, EncodeGridGrad,  //
               Activate<Relu>, ActivateGrad<Relu>, Activate<Elu>, ActivateGrad<Elu>, Activate<Softplus>,
               ActivateGrad<Softplus>, Activate<Sigmoid>, ActivateGrad<Sigmoid>, Adam, RadianceInput,
               RadianceInputGrad, SgFitResidual, SgFitGather,  //
               SgIrradiance, SgReflection, SgReflectionGrad, ReflectionLobes, SgLobesGrad, Shade, ShadeGrad>;

}  // namespace cei3d

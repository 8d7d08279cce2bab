// SPDX-License-Identifier: Apache-2.0
// The one list of kernels, by name: a kernel's place in it is its place in every launch table. Adding one
// touches no backend and no file that launches none: only headers of kernels include this header;
// core/compute/device.h does not.
#pragma once

namespace cei3d {

template <class... K>
struct KernelList {
  // The place of X in the list; -1 where it is not in it.
  template <class X>
  static constexpr int index_of() {
    constexpr bool same[] = {__is_same(X, K)...};
    for (int i = 0; i < int(sizeof...(K)); ++i)
      if (same[i]) return i;
    return -1;
  }
};

// kernels/activate.h, and the functions of core/math/activation.h
template <class A>
struct Activate;
template <class A>
struct ActivateGrad;
template <class A>
struct ActivateTwice;
struct Relu;
struct Elu;
struct Softplus;
struct Sigmoid;
// kernels/adam.h
struct Adam;
// kernels/encode.h
struct EncodePoint;
struct EncodeFrequency;
struct EncodeGrid;
struct EncodeGridGrad;
// kernels/field_hit.h
struct FieldHits;
struct FieldHitsGrad;
// kernels/light.h
struct SgFitResidual;
struct SgFitGather;
// kernels/network_gradient.h
struct GradientStep;
struct GradientStepGrad;
struct ActivateGradPlus;
struct PointGradient;
struct PointGradientGrad;
// kernels/radiance.h
struct RadianceInput;
struct RadianceInputGrad;
// kernels/shade.h
struct SgIrradiance;
struct SgReflection;
struct SgReflectionGrad;
struct ReflectionLobes;
struct SgLobesGrad;
struct Shade;
struct ShadeGrad;
// kernels/single_sg.h
struct SgMirror;
struct SgMirrorGrad;
struct SgMirrorLobesGrad;

using AllKernels =
    KernelList<EncodePoint, EncodeFrequency, EncodeGrid, EncodeGridGrad,  //
               Activate<Relu>, ActivateGrad<Relu>, Activate<Elu>, ActivateGrad<Elu>, Activate<Softplus>,
               ActivateGrad<Softplus>, Activate<Sigmoid>, ActivateGrad<Sigmoid>, ActivateTwice<Relu>,
               ActivateTwice<Elu>, ActivateTwice<Softplus>, ActivateTwice<Sigmoid>,  //
               GradientStep, GradientStepGrad, ActivateGradPlus, PointGradient, PointGradientGrad, Adam,
               RadianceInput, RadianceInputGrad, SgFitResidual, SgFitGather,  //
               FieldHits, FieldHitsGrad,                                      //
               SgIrradiance, SgReflection, SgReflectionGrad, ReflectionLobes, SgLobesGrad, Shade, ShadeGrad,
               SgMirror, SgMirrorGrad, SgMirrorLobesGrad>;

template <class K>
constexpr int kernel_index() {
  constexpr int index = AllKernels::index_of<K>();
  static_assert(index >= 0, "this kernel is missing in core/compute/kernels/list.h");
  return index;
}

}  // namespace cei3d

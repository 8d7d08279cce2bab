// SPDX-License-Identifier: Apache-2.0
// Irradiance, and reflection by one spherical Gaussian, of a batch of points under light lobes, and the
// adjoints: core/math/single_sg.h. Arrays are planes [rows][stride].
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/lobes.h"
#include "core/math/single_sg.h"

namespace cei3d {

struct MirrorPlanes {
  int stride;
  const float *normals, *views;  // [3][stride] unit
  float sharpness;               // of the lobe of normals, the same for all points
};

// A light lobe seen by a point.
template <class T>
struct MirroredLight {
  Vec3<T> gap;  // from the light's axis to the mirror lobe's
  T nl;
  SgMirroredGrad<T> grad;
};
template <class T>
HD MirroredLight<T> mirrored_light(Vec3<T> n, const MirrorLobe<T>& lobe, Vec3<T> axis, T lambda) {
  const Vec3<T> gap = lobe.axis - axis;
  const T nl = dot(n, axis);
  return {gap, nl, sg_mirrored_grad(lambda, lobe.sharpness, dot(gap, gap), nl, lobe.nv)};
}

// Irradiance without occlusion, and the sum over the lobes of their colors times sg_mirrored(). Item: a
// point.
struct SgMirror {
  struct Args {
    LobePlanes lobes;
    MirrorPlanes points;
    float *irradiance, *mirrored;  // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int stride = a.points.stride;
    const Vec3<T> n = load_planes<T>(a.points.normals, stride, i),
                  v = load_planes<T>(a.points.views, stride, i);
    const MirrorLobe<T> lobe = mirror_lobe(n, v, T(a.points.sharpness));
    const T zero(0.0f);
    Vec3<T> diffuse{zero, zero, zero}, mirrored = diffuse;
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> axis = a.lobes.axis<T>(k), mu = a.lobes.mu<T>(k), gap = lobe.axis - axis;
      const T lambda = a.lobes.lambda<T>(k), nl = dot(n, axis);
      diffuse += mu * sg_irradiance(lambda, nl);
      mirrored += mu * sg_mirrored(lambda, lobe.sharpness, dot(gap, gap), nl, lobe.nv);
    }
    for (int c = 0; c < 3; ++c) {
      diffuse[c] = max(diffuse[c], zero);
      mirrored[c] = max(mirrored[c], zero);
    }
    store_planes(a.irradiance, stride, i, diffuse);
    store_planes(a.mirrored, stride, i, mirrored);
  }
};

// Adjoint of SgMirror for the points, as if nothing were clamped at zero and the length of normals were free.
// Item: a point.
struct SgMirrorGrad {
  struct Args {
    LobePlanes lobes;
    MirrorPlanes points;
    const float *d_irradiance, *d_mirrored;  // [3][stride]
    float* d_normals;                        // [3][stride], written
    float* d_sharpness;                      // [stride], written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int stride = a.points.stride;
    const Vec3<T> n = load_planes<T>(a.points.normals, stride, i),
                  v = load_planes<T>(a.points.views, stride, i),
                  e = load_planes<T>(a.d_irradiance, stride, i), g = load_planes<T>(a.d_mirrored, stride, i);
    const T sharpness(a.points.sharpness), zero(0.0f);
    const MirrorLobe<T> lobe = mirror_lobe(n, v, sharpness);
    MirrorLobe<T> d_lobe{{zero, zero, zero}, zero, zero};
    Vec3<T> d_normal{zero, zero, zero};
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> axis = a.lobes.axis<T>(k), mu = a.lobes.mu<T>(k);
      const T lambda = a.lobes.lambda<T>(k), d = dot(g, mu);
      const MirroredLight<T> m = mirrored_light(n, lobe, axis, lambda);
      d_normal += axis * (dot(e, mu) * sg_irradiance_grad(lambda, m.nl).d_cosine + d * m.grad.d_nl);
      d_lobe.axis += m.gap * (T(2.0f) * d * m.grad.d_q);
      d_lobe.nv += d * m.grad.d_nr;
      d_lobe.sharpness += d * m.grad.d_sharpness;
    }
    const MirrorLobeGrad<T> d = mirror_lobe_grad(n, v, sharpness, d_lobe);
    store_planes(a.d_normals, stride, i, d_normal + d.d_normal);
    store<T>(a.d_sharpness + i, d.d_sharpness);
  }
};

// Adjoint of SgMirror for the light's lobes: the sum over the points [begin, end). Item: a lobe.
struct SgMirrorLobesGrad {
  struct Args {
    LobePlanes lobes;
    MirrorPlanes points;
    int begin, end;
    const float *d_irradiance, *d_mirrored;  // [3][stride]
    float* d_lobes;                          // [7][lobes.padded]: axis, lambda, color; written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int p = a.lobes.padded, stride = a.points.stride;
    const Vec3<T> axis = load_planes<T>(a.lobes.data, p, i), mu = load_planes<T>(a.lobes.data + 4 * p, p, i);
    const T lambda = max(load<T>(a.lobes.data + 3 * p + i), T(0.1f)), zero(0.0f);  // padding lobes have none
    Vec3<T> d_axis{zero, zero, zero}, d_mu{zero, zero, zero};
    T d_lambda = zero;
    for (int h = a.begin; h < a.end; ++h) {
      const auto at = [&](const float* v) {
        return Vec3<T>{T(v[h]), T(v[stride + h]), T(v[2 * stride + h])};
      };
      const Vec3<T> n = at(a.points.normals), e = at(a.d_irradiance), g = at(a.d_mirrored);
      const MirrorLobe<T> lobe = mirror_lobe(n, at(a.points.views), T(a.points.sharpness));
      const MirroredLight<T> m = mirrored_light(n, lobe, axis, lambda);
      const SgCosineGrad<T> diffuse = sg_irradiance_grad(lambda, m.nl);
      const T d_diffuse = dot(e, mu), d = dot(g, mu);
      d_mu += e * diffuse.value + g * m.grad.value;
      d_lambda += d_diffuse * diffuse.d_lambda + d * m.grad.d_lambda;
      d_axis += n * (d_diffuse * diffuse.d_cosine + d * m.grad.d_nl) - m.gap * (T(2.0f) * d * m.grad.d_q);
    }
    store_planes(a.d_lobes, p, i, d_axis);
    store<T>(a.d_lobes + 3 * p + i, d_lambda);
    store_planes(a.d_lobes + 4 * p, p, i, d_mu);
  }
};

}  // namespace cei3d

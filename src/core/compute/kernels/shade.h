// SPDX-License-Identifier: Apache-2.0
// Shading of a batch of surface points under light lobes, every point with a material of its own, and the
// adjoints. Arrays are planes [rows][stride]: a row for every component, stride is the number of points
// padded to a multiple of 32.
#pragma once

#include "core/compute/kernels/light.h"
#include "core/math/horizon.h"
#include "core/math/shading.h"

namespace cei3d {

// Irradiance of the environment without occlusion. Item: a point.
struct SgIrradiance {
  struct Args {
    LobePlanes lobes;
    int stride;
    const float* normals;  // [3][stride] unit
    float* out;            // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> n = load_planes<T>(a.normals, a.stride, i);
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k)
      sum += a.lobes.mu<T>(k) * sg_irradiance(a.lobes.lambda<T>(k), dot(n, a.lobes.axis<T>(k)));
    for (int c = 0; c < 3; ++c) sum[c] = max(sum[c], T(0.0f));
    store_planes(a.out, a.stride, i, sum);
  }
};

// The reflection lobes of points, as planes; core/math/reflection_axis.h.
struct ReflectionPlanes {
  const float *axes, *across;        // [3][stride] unit
  const float* normals;              // [3][stride] unit; 0: without a horizon
  const float *roughness, *stretch;  // [stride]
};

// The distance of a light lobe from a reflection lobe.
template <class T>
struct LobeGap {
  Vec3<T> along;  // from the light's axis to the reflection's
  T across;
  HD T q() const { return dot(along, along); }
  HD T h() const { return across * across; }
};
template <class T>
HD LobeGap<T> lobe_gap(Vec3<T> axis, Vec3<T> across, Vec3<T> light) {
  const Vec3<T> gap = axis - light;
  return {gap, dot(gap, across)};
}

// Mean radiance of the environment over the reflection lobe, as far as it is above the horizon, without
// occlusion. Item: a point.
struct SgReflection {
  struct Args {
    LobePlanes lobes;
    int stride;
    ReflectionPlanes points;
    float* out;  // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.points.axes, a.stride, i),
                  across = load_planes<T>(a.points.across, a.stride, i),
                  n = load_planes<T>(a.points.normals, a.stride, i);
    const StretchedLobe<T> lobe =
        stretched_lobe(load<T>(a.points.roughness + i), load<T>(a.points.stretch + i));
    const Horizon<T> horizon = horizon_of(lobe, dot(n, r));
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> axis = a.lobes.axis<T>(k);
      const T lambda = a.lobes.lambda<T>(k);
      const LobeGap<T> gap = lobe_gap(r, across, axis);
      sum += a.lobes.mu<T>(k) *
             (sg_reflected(lambda, lobe, gap.q(), gap.h()) * horizon.share(lambda, dot(n, axis)));
    }
    store_planes(a.out, a.stride, i, sum);
  }
};

// Adjoint of SgReflection for the points' lobes, as if the length of axes were free. Item: a point.
struct SgReflectionGrad {
  struct Args {
    LobePlanes lobes;
    int stride;
    ReflectionPlanes points;
    const float* d_reflected;              // [3][stride]
    float *d_axes, *d_across, *d_normals;  // [3][stride], written
    float *d_roughness, *d_stretch;        // [stride], written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.points.axes, a.stride, i),
                  across = load_planes<T>(a.points.across, a.stride, i),
                  n = load_planes<T>(a.points.normals, a.stride, i),
                  g = load_planes<T>(a.d_reflected, a.stride, i);
    const T roughness = load<T>(a.points.roughness + i), stretch = load<T>(a.points.stretch + i), zero(0.0f);
    const StretchedLobe<T> lobe = stretched_lobe(roughness, stretch);
    const Horizon<T> horizon = horizon_of(lobe, dot(n, r));
    StretchedLobe<T> d_lobe;
    for (int j = 0; j < kReflectionLobes; ++j) d_lobe.along[j] = d_lobe.across[j] = d_lobe.weight[j] = zero;
    Vec3<T> d_axis{zero, zero, zero}, d_across{zero, zero, zero}, d_normal{zero, zero, zero};
    T d_sharpness = zero, d_height = zero;
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> axis = a.lobes.axis<T>(k);
      const T lambda = a.lobes.lambda<T>(k), d = dot(g, a.lobes.mu<T>(k));
      const LobeGap<T> gap = lobe_gap(r, across, axis);
      const HorizonShareGrad<T> above = horizon.share_grad(lambda, dot(n, axis));
      const SgDistanceGrad<T> s =
          sg_reflected_lobe_grad(lambda, lobe, gap.q(), gap.h(), d * above.value, d_lobe);
      const T d_side = T(2.0f) * gap.across * s.d_h, d_above = d * s.value;
      d_axis += gap.along * (T(2.0f) * s.d_q) + across * d_side;
      d_across += gap.along * d_side;
      d_normal += axis * (d_above * above.d_cosine);
      d_sharpness += d_above * above.d_sharpness;
      d_height += d_above * above.d_height;
    }
    d_height = horizon_grad(dot(n, r), d_sharpness, d_height, d_lobe);
    d_axis += n * d_height;
    d_normal += r * d_height;
    const LobeMaterialGrad<T> d = stretched_lobe_grad(roughness, stretch, d_lobe);
    store_planes(a.d_axes, a.stride, i, d_axis);
    store_planes(a.d_across, a.stride, i, d_across);
    store_planes(a.d_normals, a.stride, i, d_normal);
    store<T>(a.d_roughness + i, d.d_roughness);
    store<T>(a.d_stretch + i, d.d_stretch);
  }
};

// The reflection lobes of points, for SgLobesGrad, whose items are the light's lobes. Item: a point.
struct ReflectionLobes {
  static constexpr int kRows = 3 * kReflectionLobes;  // sharpness along, across, weights
  struct Args {
    int stride;
    const float *roughness, *stretch;  // [stride]
    float* out;                        // [kRows][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const StretchedLobe<T> lobe = stretched_lobe(load<T>(a.roughness + i), load<T>(a.stretch + i));
    for (int j = 0; j < kReflectionLobes; ++j) {
      store<T>(a.out + j * a.stride + i, lobe.along[j]);
      store<T>(a.out + (kReflectionLobes + j) * a.stride + i, lobe.across[j]);
      store<T>(a.out + (2 * kReflectionLobes + j) * a.stride + i, lobe.weight[j]);
    }
  }
};

// Adjoint of SgIrradiance and SgReflection for the light's lobes: the sum over the points [begin, end). Item:
// a lobe.
struct SgLobesGrad {
  struct Args {
    LobePlanes lobes;
    int stride, begin, end;
    const float *normals, *axes, *across;     // [3][stride]
    const float* reflection_lobes;            // [ReflectionLobes::kRows][stride]
    const float *d_irradiance, *d_reflected;  // [3][stride]
    float* d_lobes;                           // [7][lobes.padded]: axis, lambda, color; written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const int p = a.lobes.padded;
    const Vec3<T> axis = load_planes<T>(a.lobes.data, p, i), mu = load_planes<T>(a.lobes.data + 4 * p, p, i);
    const T lambda = max(load<T>(a.lobes.data + 3 * p + i), T(0.1f)), zero(0.0f);  // padding lobes have none
    Vec3<T> d_axis{zero, zero, zero}, d_mu{zero, zero, zero};
    T d_lambda = zero;
    for (int h = a.begin; h < a.end; ++h) {
      const Vec3<T> n = point<T>(a.normals, a.stride, h), e = point<T>(a.d_irradiance, a.stride, h);
      const SgCosineGrad<T> diffuse = sg_irradiance_grad(lambda, dot(n, axis));
      const T d_diffuse = dot(e, mu);
      const Vec3<T> g = point<T>(a.d_reflected, a.stride, h), across = point<T>(a.across, a.stride, h);
      const Vec3<T> r = point<T>(a.axes, a.stride, h);
      const LobeGap<T> gap = lobe_gap(r, across, axis);
      const StretchedLobe<T> mirror = lobe<T>(a, h);
      const SgReflectedGrad<T> specular = sg_reflected_grad(lambda, mirror, gap.q(), gap.h());
      const HorizonShareGrad<T> above = horizon_of(mirror, dot(n, r)).share_grad(lambda, dot(n, axis));
      const T d_specular = dot(g, mu) * above.value, d_above = dot(g, mu) * specular.value;
      d_mu += e * diffuse.value + g * (specular.value * above.value);
      d_lambda += d_diffuse * diffuse.d_lambda + d_specular * specular.d_lambda + d_above * above.d_lambda;
      d_axis += n * (d_diffuse * diffuse.d_cosine + d_above * above.d_cosine) -
                (gap.along * specular.d_q + across * (gap.across * specular.d_h)) * (T(2.0f) * d_specular);
    }
    store_planes(a.d_lobes, p, i, d_axis);
    store<T>(a.d_lobes + 3 * p + i, d_lambda);
    store_planes(a.d_lobes + 4 * p, p, i, d_mu);
  }

 private:
  template <class T>
  static HD Vec3<T> point(const float* p, int stride, int i) {
    return {T(p[i]), T(p[stride + i]), T(p[2 * stride + i])};
  }
  template <class T>
  static HD StretchedLobe<T> lobe(const Args& a, int point) {
    const auto row = [&](int r) { return T(a.reflection_lobes[r * a.stride + point]); };
    StretchedLobe<T> lobe;
    for (int j = 0; j < kReflectionLobes; ++j) {
      lobe.along[j] = row(j);
      lobe.across[j] = row(kReflectionLobes + j);
      lobe.weight[j] = row(2 * kReflectionLobes + j);
    }
    return lobe;
  }
};

// The rows of a ShadingPoint, in the order of its members.
struct ShadingRows {
  static constexpr int kAlbedo = 0, kRoughness = 3, kSpecular = 4, kMetalness = 5, kNv = 6, kIrradiance = 7,
                       kReflected = 10, kDiffuseLight = 13, kRows = 16;
  template <class T>
  static HD ShadingPoint<T> load_point(const float* p, int stride, int i) {
    const auto row = [&](int r) { return p + r * stride; };
    return {load_planes<T>(row(kAlbedo), stride, i),
            load<T>(row(kRoughness) + i),
            load<T>(row(kSpecular) + i),
            load<T>(row(kMetalness) + i),
            load<T>(row(kNv) + i),
            load_planes<T>(row(kIrradiance), stride, i),
            load_planes<T>(row(kReflected), stride, i),
            {load<T>(row(kDiffuseLight) + i), load<T>(row(kDiffuseLight + 1) + i),
             load<T>(row(kDiffuseLight + 2) + i)}};
  }
  template <class T>
  static HD void store_point(float* p, int stride, int i, const ShadingPoint<T>& x) {
    const auto row = [&](int r) { return p + r * stride; };
    store_planes(row(kAlbedo), stride, i, x.albedo);
    store<T>(row(kRoughness) + i, x.roughness);
    store<T>(row(kSpecular) + i, x.specular);
    store<T>(row(kMetalness) + i, x.metalness);
    store<T>(row(kNv) + i, x.nv);
    store_planes(row(kIrradiance), stride, i, x.irradiance);
    store_planes(row(kReflected), stride, i, x.reflected);
    store<T>(row(kDiffuseLight) + i, x.diffuse_light.lv);
    store<T>(row(kDiffuseLight + 1) + i, x.diffuse_light.grazing);
    store<T>(row(kDiffuseLight + 2) + i, x.diffuse_light.grazing_lv);
  }
};

// The radiance of points as a linear function of their albedo. Item: a point.
struct Shade {
  static constexpr int kOutputs = 9;  // diffuse_gain, specular_gain, specular_offset
  struct Args {
    const float* split_sum;  // split_sum_table()
    int stride;
    const float* points;  // [ShadingRows::kRows][stride]; the albedo's rows are not read
    float* terms;         // [kOutputs][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const ShadingTerms<T> t = shading_terms(a.split_sum, ShadingRows::load_point<T>(a.points, a.stride, i));
    store_planes(a.terms, a.stride, i, t.diffuse_gain);
    store_planes(a.terms + 3 * a.stride, a.stride, i, t.specular_gain);
    store_planes(a.terms + 6 * a.stride, a.stride, i, t.specular_offset);
  }
};

// Adjoint of Shade and of the linear function that it makes. Item: a point.
struct ShadeGrad {
  struct Args {
    const float* split_sum;
    int stride;
    const float* points;                  // [ShadingRows::kRows][stride]
    const float *d_diffuse, *d_specular;  // [3][stride]
    float* d_points;                      // [ShadingRows::kRows][stride], written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    ShadingRows::store_point(
        a.d_points, a.stride, i,
        shading_grad(a.split_sum, ShadingRows::load_point<T>(a.points, a.stride, i),
                     load_planes<T>(a.d_diffuse, a.stride, i), load_planes<T>(a.d_specular, a.stride, i)));
  }
};

}  // namespace cei3d

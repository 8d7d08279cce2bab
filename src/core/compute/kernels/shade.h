// SPDX-License-Identifier: Apache-2.0
// Shading of a batch of surface points under light lobes, every point with a material of its own, and the
// adjoints. Arrays are planes [rows][stride]: a row for every component, stride is the number of points
// padded to a multiple of 32.
#pragma once

#include "core/compute/kernels/light.h"
#include "core/math/reflection.h"
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

// Mean radiance of the environment over the reflection lobe, without occlusion. Item: a point.
struct SgReflection {
  struct Args {
    LobePlanes lobes;
    int stride;
    const float* axes;       // [3][stride] unit, core/math/reflection_axis.h
    const float* roughness;  // [stride]
    float* out;              // [3][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.axes, a.stride, i);
    const ReflectionLobe<T> lobe = reflection_lobe(load<T>(a.roughness + i));
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> d = r - a.lobes.axis<T>(k);
      sum += a.lobes.mu<T>(k) * sg_reflected(a.lobes.lambda<T>(k), lobe, dot(d, d));
    }
    store_planes(a.out, a.stride, i, sum);
  }
};

// Adjoint of SgReflection for the axes, as if their length were free, and for the roughness.
// Item: a point.
struct SgReflectionGrad {
  struct Args {
    LobePlanes lobes;
    int stride;
    const float *axes, *roughness;  // as in SgReflection
    const float* d_reflected;       // [3][stride]
    float* d_axes;                  // [3][stride], written
    float* d_roughness;             // [stride], written
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> r = load_planes<T>(a.axes, a.stride, i), g = load_planes<T>(a.d_reflected, a.stride, i);
    const ReflectionLobeGrad<T> lobe = reflection_lobe_grad(load<T>(a.roughness + i));
    Vec3<T> d_axis{T(0.0f), T(0.0f), T(0.0f)};
    T d_roughness(0.0f);
    for (int k = 0; k < a.lobes.count; ++k) {
      const Vec3<T> d = r - a.lobes.axis<T>(k);
      const T weight = dot(g, a.lobes.mu<T>(k));
      const SgReflectedMaterialGrad<T> s = sg_reflected_material_grad(a.lobes.lambda<T>(k), lobe, dot(d, d));
      d_axis += d * (T(2.0f) * weight * s.d_q);
      d_roughness += weight * s.d_roughness;
    }
    store_planes(a.d_axes, a.stride, i, d_axis);
    store<T>(a.d_roughness + i, d_roughness);
  }
};

// The reflection lobes of the points' roughness, for SgLobesGrad, whose items are the light's lobes. Item: a
// point.
struct ReflectionLobes {
  static constexpr int kRows = 2 * kReflectionLobes;  // sharpness, then weights
  struct Args {
    int stride;
    const float* roughness;  // [stride]
    float* out;              // [kRows][stride]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const ReflectionLobe<T> lobe = reflection_lobe(load<T>(a.roughness + i));
    for (int j = 0; j < kReflectionLobes; ++j) {
      store<T>(a.out + j * a.stride + i, lobe.lambda[j]);
      store<T>(a.out + (kReflectionLobes + j) * a.stride + i, lobe.weight[j]);
    }
  }
};

// Adjoint of SgIrradiance and SgReflection for the light's lobes: the sum over the points [begin, end). Item:
// a lobe.
struct SgLobesGrad {
  struct Args {
    LobePlanes lobes;
    int stride, begin, end;
    const float *normals, *axes;              // [3][stride]
    const float* reflection_lobes;            // [ReflectionLobes::kRows][stride]
    const float *d_irradiance, *d_reflected;  // [3][stride]
    float* d_lobes;                           // [7][lobes.padded]: axis, sharpness, color; written
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
      const Vec3<T> g = point<T>(a.d_reflected, a.stride, h), gap = point<T>(a.axes, a.stride, h) - axis;
      const SgReflectedGrad<T> specular = sg_reflected_grad(lambda, lobe<T>(a, h), dot(gap, gap));
      const T d_specular = dot(g, mu);
      d_mu += e * diffuse.value + g * specular.value;
      d_lambda += d_diffuse * diffuse.d_lambda + d_specular * specular.d_lambda;
      d_axis += n * (d_diffuse * diffuse.d_cosine) + gap * (T(-2.0f) * d_specular * specular.d_q);
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
  static HD ReflectionLobe<T> lobe(const Args& a, int point) {
    ReflectionLobe<T> lobe;
    for (int j = 0; j < kReflectionLobes; ++j) {
      lobe.lambda[j] = T(a.reflection_lobes[j * a.stride + point]);
      lobe.weight[j] = T(a.reflection_lobes[(kReflectionLobes + j) * a.stride + point]);
    }
    return lobe;
  }
};

// The rows of a ShadingPoint, in the order of its members.
struct ShadingRows {
  static constexpr int kAlbedo = 0, kRoughness = 3, kSpecular = 4, kMetalness = 5, kNv = 6, kIrradiance = 7,
                       kReflected = 10, kRows = 13;
  template <class T>
  static HD ShadingPoint<T> load_point(const float* p, int stride, int i) {
    const auto row = [&](int r) { return p + r * stride; };
    return {load_planes<T>(row(kAlbedo), stride, i),
            load<T>(row(kRoughness) + i),
            load<T>(row(kSpecular) + i),
            load<T>(row(kMetalness) + i),
            load<T>(row(kNv) + i),
            load_planes<T>(row(kIrradiance), stride, i),
            load_planes<T>(row(kReflected), stride, i)};
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

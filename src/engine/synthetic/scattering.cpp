// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/scattering.h"

#include <cmath>

#include "core/math/color.h"
#include "core/math/facets.h"
#include "core/math/shading.h"

namespace cei3d {

Scattering::Scattering(Vec3f normal, Vec3f to_viewer, const Material& m, Vec3f albedo, Diffuse model)
    : normal_(normal),
      view_(to_viewer),
      tangents_(tangents_of(normal)),
      nv_(max(dot(normal, to_viewer), 1e-4f)),
      roughness_(m.roughness),
      alpha_(m.roughness * m.roughness),
      f0_(f0_of(albedo, m.specular, m.metalness)),
      f90_(f90_of(m.specular, m.metalness)),
      model_(model) {
  diffuse_ = albedo * (1 - m.metalness);
  const float mirror = fresnel(luminance(f0_), nv_), base = luminance(diffuse_);
  mirror_share_ = base > 0 ? clamp(mirror / (mirror + base), 0.2f, 0.8f) : 1.0f;
}

Vec3f Scattering::reflected(Vec3f l) const {
  const float nl = dot(normal_, l);
  if (nl <= 0) return {0, 0, 0};
  // Fresnel's term, and with it the whole, is linear in F0 and F90.
  const float grazing = microfacet_brdf(normal_, view_, l, 0.0f, roughness_),
              both = microfacet_brdf(normal_, view_, l, 1.0f, roughness_);
  float base = 1;
  if (model_ == Diffuse::burley)
    base = burley_diffuse(min(nl, 1.0f), min(nv_, 1.0f), dot(l, normalize(l + view_)), roughness_);
  const Vec3f mirror = Vec3f{grazing, grazing, grazing} * f90_ + f0_ * (both - grazing);
  return (mirror + diffuse_ * (base / kPi)) * nl;
}

float Scattering::density(Vec3f l) const {
  const Vec3f h = normalize(view_ + l);
  const float nh = max(dot(normal_, h), 0.0f), vh = max(dot(view_, h), 1e-4f);
  const float mirror = ggx_density(nh, alpha_) * nh / (4 * vh);
  const float base = max(dot(normal_, l), 0.0f) / kPi;
  return mirror_share_ * mirror + (1 - mirror_share_) * base;
}

Vec3f Scattering::sample(float pick, Vec2<float> u) const {
  const bool mirror = pick < mirror_share_;
  // Squared cosine to the normal: of a facet in proportion to its projected area, or of a diffuse direction.
  const float c2 = mirror ? ggx_facet_cosine2(u.x, alpha_) : 1 - u.x;
  const float c = std::sqrt(c2), s = std::sqrt(max(1 - c2, 0.0f)), turn = 2 * kPi * u.y;
  const Vec3f d =
      normalize(tangents_.x * (s * std::cos(turn)) + tangents_.y * (s * std::sin(turn)) + normal_ * c);
  return mirror ? mirrored_direction(d, view_) : d;
}

}  // namespace cei3d

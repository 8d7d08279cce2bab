// SPDX-License-Identifier: Apache-2.0
#include "engine/render/vertex_light.h"

#include "core/base/error.h"
#include "core/math/sg.h"

namespace cei3d {
namespace {

constexpr float kSkyLobe = 256;  // sharpness of a lobe as wide as the spacing of sky_directions()

Vec3f fraction(Vec3f part, Vec3f whole) {
  Vec3f f;
  for (int c = 0; c < 3; ++c) f[c] = whole[c] > 1e-6f ? min(part[c] / whole[c], 1.0f) : 1.0f;
  return f;
}

// Computes the light of the vertices that the transport covers, with two diffuse bounces. Metals, which have
// no diffuse term, count as diffuse with their reflectance as albedo. visible, unoccluded: irradiance of the
// vertices from the sky with and without occlusion.
void relight(const Transport& transport, const std::vector<Vec3f>& visible,
             const std::vector<Vec3f>& unoccluded, VertexLight& v) {
  const size_t n = visible.size();
  for (size_t i = 0; i < n; ++i) {
    if (!transport.covers(i)) continue;
    v.visibility[i] = fraction(visible[i], unoccluded[i]);
    v.bounce[i] = {0, 0, 0};
  }
  std::vector<Vec3f> radiance(n);
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < n; ++i) {
      if (transport.covers(i)) v.irradiance[i] = visible[i] + v.bounce[i];
      radiance[i] = v.made_of.albedo[i] * v.irradiance[i] / kPi;
    }
    const std::vector<Vec3f> bounce = transport.bounce(radiance);
    for (size_t i = 0; i < n; ++i)
      if (transport.covers(i)) v.bounce[i] = bounce[i];
  }
}

void take_materials(const Transport& transport, VertexMaterials&& made_of, VertexLight& v) {
  const size_t old = v.made_of.albedo.size();
  v.made_of.albedo.resize(made_of.albedo.size());
  v.made_of.material.resize(made_of.material.size());
  for (size_t i = 0; i < made_of.albedo.size(); ++i) {
    if (i < old && !transport.covers(i)) continue;
    v.made_of.albedo[i] = made_of.albedo[i];
    v.made_of.material[i] = made_of.material[i];
  }
}

VertexLight lit(VertexLight before, const Transport& transport, const std::vector<Vec3f>& visible,
                const std::vector<Vec3f>& unoccluded, VertexMaterials made_of) {
  const size_t n = transport.surface().mesh().positions.size();
  if (made_of.albedo.size() != n || made_of.material.size() != n)
    fail("There are {} albedos and {} materials for {} vertices (an error in the program).",
         made_of.albedo.size(), made_of.material.size(), n);
  take_materials(transport, std::move(made_of), before);
  for (auto* a : {&before.visibility, &before.bounce, &before.irradiance}) a->resize(n, {0, 0, 0});
  relight(transport, visible, unoccluded, before);
  return before;
}

}  // namespace

SkyRadiance sky_radiance(const SgMixture& light) {
  SkyRadiance out;
  const float unit = 1 / sg_integral(kSkyLobe);
  for (const Vec3f d : sky_directions()) {
    Vec3f sum{0, 0, 0};
    for (const SgLobe& l : light.lobes) {
      const Vec3f gap = d - l.axis;
      sum += l.mu * (unit * sg_inner(l.lambda, kSkyLobe, dot(gap, gap)));
    }
    out.push_back(sum);
  }
  return out;
}

VertexLight vertex_light(const Transport& transport, const SgMixture& light, VertexMaterials made_of) {
  return vertex_light_after({}, transport, light, std::move(made_of));
}

std::vector<VertexLight> turned_vertex_lights(const Transport& transport, const SgMixture& light,
                                              const VertexMaterials& made_of, const LightTurns* turns) {
  if (!turns) return {vertex_light(transport, light, made_of)};
  std::vector<SkyRadiance> skies;
  for (const Mat3f& room_from_object : turns->bins)
    skies.push_back(sky_radiance(rotated(light, transpose(room_from_object))));
  const std::vector<std::vector<Vec3f>> visible = transport.skies(skies),
                                        unoccluded = transport.unoccluded_skies(skies, visible);
  std::vector<VertexLight> out;
  for (size_t bin = 0; bin < skies.size(); ++bin) {
    out.push_back(lit({}, transport, visible[bin], unoccluded[bin], made_of));
    if (bin > 0) out.back().made_of = {};
  }
  return out;
}

VertexLight vertex_light_after(VertexLight before, const Transport& transport, const SgMixture& light,
                               VertexMaterials made_of) {
  const SkyRadiance sky = sky_radiance(light);
  const std::vector<Vec3f> visible = transport.sky(sky);
  return lit(std::move(before), transport, visible, transport.unoccluded_sky(sky, visible),
             std::move(made_of));
}

}  // namespace cei3d

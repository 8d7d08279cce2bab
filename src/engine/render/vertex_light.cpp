// SPDX-License-Identifier: Apache-2.0
#include "engine/render/vertex_light.h"

#include "core/base/error.h"
#include "core/math/sg.h"

namespace cei3d {
namespace {

constexpr float kSkyLobe = 256;  // sharpness of a lobe as wide as the spacing of sky_directions()

Vec3f share(Vec3f seen, Vec3f open) {
  Vec3f s;
  for (int c = 0; c < 3; ++c) s[c] = open[c] > 1e-6f ? min(seen[c] / open[c], 1.0f) : 1.0f;
  return s;
}

// Lights the transport's vertices.
void relight(const Transport& transport, const SgMixture& light, std::span<const Vec3f> base_color,
             VertexLight& v) {
  const SkyRadiance sky = sky_radiance(light);
  const std::vector<Vec3f> seen = transport.sky(sky), open = transport.open_sky(sky);
  const size_t n = seen.size();
  for (size_t i = 0; i < n; ++i) {
    if (!transport.covers(i)) continue;
    v.base_color[i] = base_color[i];
    v.openness[i] = share(seen[i], open[i]);
    v.bounce[i] = {0, 0, 0};
  }
  std::vector<Vec3f> leaving(n);
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < n; ++i) {
      if (transport.covers(i)) v.arriving[i] = (seen[i] + v.bounce[i]) / kPi;
      leaving[i] = v.base_color[i] * v.arriving[i];
    }
    const std::vector<Vec3f> bounce = transport.bounce(leaving);
    for (size_t i = 0; i < n; ++i)
      if (transport.covers(i)) v.bounce[i] = bounce[i];
  }
}

void resize(VertexLight& v, size_t n) {
  for (auto* a : {&v.base_color, &v.openness, &v.bounce, &v.arriving}) a->resize(n, {0, 0, 0});
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

VertexLight vertex_light(const Transport& transport, const SgMixture& light,
                         std::span<const Vec3f> base_color) {
  return vertex_light_after({}, transport, light, base_color);
}

VertexLight vertex_light_after(VertexLight before, const Transport& transport, const SgMixture& light,
                               std::span<const Vec3f> base_color) {
  const size_t n = transport.surface().mesh().positions.size();
  if (base_color.size() != n) fail("lighting: {} colours for {} vertices", base_color.size(), n);
  resize(before, n);
  relight(transport, light, base_color, before);
  return before;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/compute/kernels/shade.h"
#include "core/math/brdf.h"
#include "core/math/sg.h"
#include "engine/render/env_table.h"
#include "engine/render/self_reflection.h"

namespace cei3d {
namespace {

constexpr int kBlock = 2048;  // hits a chunk: what it needs stays in the second-level cache

}  // namespace

Lighting::Lighting(const Device& device, const Surface& surface, const SgMixture& light,
                   const Material& material, VertexLight vertices)
    : device_(device), surface_(surface), material_(material), vertices_(std::move(vertices)) {
  set_lobes(light);
  env_table_ = env_brdf_table(max(material.roughness, kLeastRoughness));
}

Lighting::Lighting(const Device& device, const Surface& surface, const SgMixture& light,
                   std::span<const Vec3f> base_color, const Material& material,
                   std::shared_ptr<const Transport> transport)
    : Lighting(device, surface, light, material,
               vertex_light(transport ? *transport : Transport(surface), light, base_color)) {}

Lighting::~Lighting() = default;

void Lighting::set_lobes(const SgMixture& light) {
  n_lobes_ = int(light.lobes.size());
  padded_ = (n_lobes_ + kPanel - 1) / kPanel * kPanel;
  lobe_planes_.assign(size_t(7) * padded_, 0);
  for (int k = 0; k < n_lobes_; ++k) {
    const SgLobe& l = light.lobes[k];
    const float row[] = {l.axis.x, l.axis.y, l.axis.z, clamp(l.lambda, kBroadestLobe, kSharpestLobe),
                         l.mu.x,   l.mu.y,   l.mu.z};
    for (int j = 0; j < 7; ++j) lobe_planes_[size_t(j) * padded_ + k] = row[j];
  }
  irradiance_ = IrradianceMap(device_, {lobe_planes_.data(), n_lobes_, padded_});
}

// Planes of one chunk of hits.
struct Lighting::Block {
  std::vector<float> mirrors, reflected;
  Block() {
    for (auto* v : {&mirrors, &reflected}) v->assign(size_t(3) * kBlock, 0);
  }
};

HitLight Lighting::light_at(std::span<const Hit> hits, const Material& material,
                            std::span<const Vec3f> seen) const {
  const Mesh& mesh = surface_.mesh();
  const float roughness = max(material.roughness, kLeastRoughness);
  const bool own = roughness == max(material_.roughness, kLeastRoughness);
  const std::vector<Vec2f> other_table = own ? std::vector<Vec2f>() : env_brdf_table(roughness);
  const std::vector<Vec2f>& env_table = own ? env_table_ : other_table;
  HitLight out;
  out.irradiance.resize(hits.size());
  out.reflected.resize(hits.size());
  out.openness.resize(hits.size());
  out.open_mirror.resize(hits.size());
  out.env.resize(hits.size());
  out.diffuse_view.resize(hits.size());
  const LobePlanes lobes{lobe_planes_.data(), n_lobes_, padded_};
  const SelfReflection own_image(device_, surface_, vertices_, lobes, material, env_table,
                                 seen.empty() ? std::span<const Vec3f>(vertices_.base_color) : seen);
  parallel_ranges(int(hits.size()), kBlock, [&](int begin, int end) {
    Block b;
    for (int i = begin; i < end; ++i) {
      const Vec3f r = mirror_direction(hits[i]);
      for (int c = 0; c < 3; ++c) b.mirrors[size_t(c) * kBlock + i - begin] = r[c];
    }
    const int n = (end - begin + kPanel - 1) / kPanel * kPanel;
    SgReflection::Args reflection{lobes, {}, {}, kBlock, b.mirrors.data(), b.reflected.data()};
    set_reflection_lobe(roughness, reflection);
    device_.launch<SgReflection>(reflection, n);
    const std::vector<SelfReflection::Seen> way = own_image.seen_by(hits.subspan(begin, end - begin));
    for (int i = begin; i < end; ++i) {
      const Hit& h = hits[i];
      const auto& t = mesh.triangles[h.triangle];
      const Vec3f soft = normalize(at_corners(mesh.normals, t, h.b1, h.b2));
      const Vec3f sky{b.reflected[i - begin], b.reflected[kBlock + i - begin],
                      b.reflected[2 * kBlock + i - begin]};
      out.openness[i] = at_corners(vertices_.openness, t, h.b1, h.b2);
      out.irradiance[i] =
          irradiance_.at(soft) * out.openness[i] + at_corners(vertices_.bounce, t, h.b1, h.b2);
      out.open_mirror[i] = max(way[i - begin].open, 0.0f);
      out.reflected[i] = sky * out.open_mirror[i] + way[i - begin].radiance;
      const float nv = dot(h.normal, h.to_camera);
      out.env[i] = env_brdf_at(env_table, nv);
      out.diffuse_view[i] = diffuse_view(clamp(nv, 0.0f, 1.0f), roughness);
    }
  });
  return out;
}

// Adjoint of the free sky's reflection: dL/d(mirror direction) from dL/d(radiance along it).
std::vector<Vec3f> Lighting::mirror_slopes(std::span<const Hit> hits,
                                           std::span<const Vec3f> d_reflected) const {
  std::vector<Vec3f> out(hits.size());
  parallel_ranges(int(hits.size()), kBlock, [&](int begin, int end) {
    std::vector<float> mirrors(size_t(3) * kBlock), up(mirrors.size()), down(mirrors.size());
    for (int i = begin; i < end; ++i) {
      const Vec3f r = mirror_direction(hits[i]);
      for (int c = 0; c < 3; ++c) {
        mirrors[size_t(c) * kBlock + i - begin] = r[c];
        up[size_t(c) * kBlock + i - begin] = d_reflected[i][c];
      }
    }
    SgReflectionSlope::Args a{
        {lobe_planes_.data(), n_lobes_, padded_}, {}, {}, kBlock, mirrors.data(), up.data(), down.data()};
    set_reflection_lobe(max(material_.roughness, kLeastRoughness), a);
    device_.launch<SgReflectionSlope>(a, (end - begin + kPanel - 1) / kPanel * kPanel);
    for (int i = begin; i < end; ++i)
      out[i] = {down[i - begin], down[kBlock + i - begin], down[2 * kBlock + i - begin]};
  });
  return out;
}

std::vector<Vec3f> Lighting::normal_slopes(std::span<const Hit> hits, const HitLight& light,
                                           std::span<const Vec3f> albedo,
                                           std::span<const Vec3f> d_radiance) const {
  constexpr float kStep = 0.01f;  // of the tabulated reflectance
  const float roughness = max(material_.roughness, kLeastRoughness);
  const auto seen_at = [&](float nv) { return diffuse_view(clamp(nv, 0.0f, 1.0f), roughness); };
  const float dielectric = (1 - material_.metalness) * kDielectricF0 * material_.specular;
  std::vector<Vec3f> d_reflected(hits.size()), out(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const float nv = dot(hits[i].normal, hits[i].to_camera);
    const Vec2f above = env_brdf_at(env_table_, nv + kStep), below = env_brdf_at(env_table_, nv - kStep);
    const float d_diffuse =
        (1 - material_.metalness) / kPi * (seen_at(nv + kStep) - seen_at(nv - kStep)) / (2 * kStep);
    float d_nv = 0;
    for (int c = 0; c < 3; ++c) {
      d_nv += d_radiance[i][c] * albedo[i][c] * light.irradiance[i][c] * d_diffuse;
      const float f0 = material_.metalness * albedo[i][c] + dielectric;
      d_reflected[i][c] = d_radiance[i][c] * (f0 * light.env[i].x + light.env[i].y) * light.open_mirror[i];
      d_nv += d_radiance[i][c] * light.reflected[i][c] * (f0 * (above.x - below.x) + above.y - below.y) /
              (2 * kStep);
    }
    out[i] = hits[i].to_camera * d_nv;
  }
  const std::vector<Vec3f> d_mirror = mirror_slopes(hits, d_reflected);
  for (size_t i = 0; i < hits.size(); ++i) {
    const Vec3f &n = hits[i].normal, &v = hits[i].to_camera, &d = d_mirror[i];
    out[i] += (v * dot(d, n) + d * dot(n, v)) * 2.0f;
    out[i] = out[i] - n * dot(out[i], n);
  }
  return out;
}

HitLight::Terms HitLight::at(size_t hit, const Material& material) const {
  const float m = material.metalness, dielectric = (1 - m) * kDielectricF0 * material.specular;
  return {irradiance[hit] * ((1 - m) / kPi * diffuse_view[hit]), reflected[hit] * (m * env[hit].x),
          reflected[hit] * (dielectric * env[hit].x + env[hit].y)};
}

// The hits of one material, as a batch of their own.
struct Lighting::Group {
  std::vector<uint32_t> index;  // in the whole batch
  std::vector<Hit> hits;
};

void Lighting::shade_group(const Group& group, std::span<const Vec3f> albedo, const Material& material,
                           std::span<const Vec3f> seen, Shading& out) const {
  const HitLight light = light_at(group.hits, material, seen);
  for (size_t k = 0; k < group.index.size(); ++k) {
    const uint32_t i = group.index[k];
    const HitLight::Terms t = light.at(k, material);
    out.diffuse[i] = albedo[i] * t.diffuse_gain;
    out.specular[i] = albedo[i] * t.specular_gain + t.specular_floor;
  }
}

Shading Lighting::shade(std::span<const Hit> hits, const Appearance& appearance,
                        std::span<const Vec3f> seen) const {
  std::vector<Group> groups(appearance.materials.size());
  for (Group& group : groups) {
    group.index.reserve(hits.size() / groups.size());
    group.hits.reserve(hits.size() / groups.size());
  }
  for (size_t i = 0; i < hits.size(); ++i) {
    Group& group = groups[appearance.material[i]];
    group.index.push_back(uint32_t(i));
    group.hits.push_back(hits[i]);
  }
  Shading out{std::vector<Vec3f>(hits.size()), std::vector<Vec3f>(hits.size())};
  for (size_t m = 0; m < groups.size(); ++m)
    if (!groups[m].hits.empty())
      shade_group(groups[m], appearance.albedo, appearance.materials[m], seen, out);
  return out;
}

Shading Lighting::shade(std::span<const Hit> hits, std::span<const Vec3f> albedo) const {
  return shade(
      hits,
      Appearance{{albedo.begin(), albedo.end()}, std::vector<uint32_t>(hits.size(), 0), {material_}, {}});
}

}  // namespace cei3d

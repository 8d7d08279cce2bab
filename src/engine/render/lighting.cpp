// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lighting.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/brdf.h"
#include "core/math/sg.h"

namespace cei3d {
namespace {

constexpr int kBlock = 2048;  // hits a chunk: what it needs stays in the second-level cache
constexpr int kEnvCells = 64;
constexpr float kLift = 2e-3f;     // rays start this far above the surface
// Rays of the reflection lobe: a few to see whether anything is in its way, and where it is, enough to see what.
constexpr int kProbes = 6, kRays = 24;
constexpr float kGrazing = 0.02f;  // least cosine of a reflection that another reflection sees

Vec3f at_corners(const std::vector<Vec3f>& v, const std::array<uint32_t, 3>& t, float b1, float b2) {
  return v[t[0]] * (1 - b1 - b2) + v[t[1]] * b1 + v[t[2]] * b2;
}

// Directions of equal weight that stand for the reflection lobe of a roughness around +Z: one ring at the
// radius that splits each equal share of its energy. 1 / (1 + x)^2 has the cumulative share x / (1 + x).
std::vector<Vec3f> lobe_directions(float roughness, int count) {
  std::vector<Vec3f> d;
  const float width = 2 / std::sqrt(reflection_scale(roughness));
  for (int k = 0; k < count; ++k) {
    const float u = (float(k) + 0.5f) / float(count);
    const float t = std::min(width * std::sqrt(u / (1 - u)), 1.4f), a = 2.399963f * float(k);
    d.push_back({std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)});
  }
  return d;
}

Vec3f mirror_direction(const Hit& h) {
  return normalize(h.normal * (2 * dot(h.normal, h.to_camera)) - h.to_camera);
}

Vec3f turned(Vec3f z, Vec3f d) {  // d in a frame whose third axis is z
  const float s = z.z < 0 ? -1.0f : 1.0f, a = -1 / (s + z.z), b = z.x * z.y * a;  // [Duff et al. 2017]
  const Vec3f x{1 + s * z.x * z.x * a, s * b, -s * z.x}, y{b, s + z.y * z.y * a, -z.y};
  return x * d.x + y * d.y + z * d.z;
}

}  // namespace

std::vector<Vec2f> env_brdf_table(float roughness) {
  std::vector<Vec2f> table(kEnvCells);
  parallel_ranges(kEnvCells, 8, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const EnvBrdf e = env_brdf(roughness, (i + 0.5) / kEnvCells);
      table[i] = {e.scale, e.bias};
    }
  });
  return table;
}

Vec2f env_brdf_at(const std::vector<Vec2f>& table, float nv) {
  const float x = clamp(nv * float(table.size()) - 0.5f, 0.0f, float(table.size() - 1));
  const int i = std::min(int(x), int(table.size()) - 2);
  const float f = x - float(i);
  return {table[i].x * (1 - f) + table[i + 1].x * f, table[i].y * (1 - f) + table[i + 1].y * f};
}

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
}

struct Lighting::Look {
  Material material;
  float roughness;  // that shading can take
  std::vector<Vec2f> env_table;
  std::vector<Vec3f> probes, lobe;  // directions around +Z
  const SeenColors& seen;

  Look(const Material& m, std::vector<Vec2f> table, const SeenColors& colors)
      : material(m),
        roughness(max(m.roughness, kLeastRoughness)),
        env_table(std::move(table)),
        probes(lobe_directions(roughness, kProbes)),
        lobe(lobe_directions(roughness, kRays)),
        seen(colors) {}
};

struct Lighting::Blocked {
  float open = 1;          // share of the lobe that sees the sky
  Vec3f seen{0, 0, 0};     // radiance from the rest, times its share
};

// Planes of one chunk of hits.
struct Lighting::Block {
  std::vector<float> normals, mirrors, irradiance, reflected;
  Block() {
    for (auto* v : {&normals, &mirrors, &irradiance, &reflected}) v->assign(size_t(3) * kBlock, 0);
  }
};

namespace {

struct LobeRays {
  std::vector<Vec3f> origins, directions;
  std::vector<Surface::RayHit> far;
};

LobeRays cast(const Surface& surface, std::span<const Hit> hits, std::span<const Vec3f> lobe) {
  LobeRays rays;
  rays.origins.reserve(hits.size() * lobe.size());
  rays.directions.reserve(hits.size() * lobe.size());
  for (const Hit& h : hits) {
    const Vec3f r = mirror_direction(h);
    for (const Vec3f& d : lobe) {
      const Vec3f ray = turned(r, d);  // below the horizon: folded up, since masking is in the reflectance already
      rays.origins.push_back(h.position + h.normal * kLift);
      rays.directions.push_back(ray - h.normal * (2 * min(dot(ray, h.normal), 0.0f)));
    }
  }
  rays.far.resize(rays.origins.size());
  surface.intersect(rays.origins, rays.directions, 0, rays.far);
  return rays;
}

}  // namespace

// A point that a ray met, looked at from where the ray began.
Hit Lighting::met_by(Vec3f origin, Vec3f direction, const Surface::RayHit& r) const {
  const Mesh& mesh = surface_.mesh();
  const Vec3f normal = normalize(at_corners(mesh.normals, mesh.triangles[r.triangle], r.b1, r.b2));
  return {origin + direction * r.t, normal, -direction, r.triangle, r.b1, r.b2};
}

// Radiance that leaves these points for where they are looked at from. What their reflection meets is taken as
// diffuse.
std::vector<Vec3f> Lighting::shown(std::span<const Hit> met, const Look& look) const {
  const Mesh& mesh = surface_.mesh();
  const size_t n = met.size(), stride = (n + kPanel - 1) / kPanel * kPanel;
  std::vector<Vec3f> from(n), mirrors(n), out(n);
  std::vector<float> mirror_planes(3 * stride, 0.0f), sky(3 * stride);
  for (size_t k = 0; k < n; ++k) {
    mirrors[k] = mirror_direction(met[k]);
    from[k] = met[k].position + met[k].normal * kLift;
    for (int c = 0; c < 3; ++c) mirror_planes[size_t(c) * stride + k] = mirrors[k][c];
  }
  SgReflection::Args args{
      {lobe_planes_.data(), n_lobes_, padded_}, {}, {}, int(stride), mirror_planes.data(), sky.data()};
  set_reflection_lobe(look.roughness, args);
  device_.launch<SgReflection>(args, int(stride));
  std::vector<Surface::RayHit> next(n);
  surface_.intersect(from, mirrors, 0, next);
  const auto at = [&](const std::vector<Vec3f>& v, const auto& h) {
    return at_corners(v, mesh.triangles[h.triangle], h.b1, h.b2);
  };
  const std::vector<Vec3f> seen = look.seen ? look.seen(met) : std::vector<Vec3f>();
  const float m = look.material.metalness, dielectric = (1 - m) * kDielectricF0 * look.material.specular;
  for (size_t k = 0; k < n; ++k) {
    const Vec3f color = seen.empty() ? at(vertices_.base_color, met[k]) : seen[k];
    const Vec3f diffuse = color * at(vertices_.arriving, met[k]);
    const Vec3f reflected = next[k].t < 0 ? Vec3f{sky[k], sky[stride + k], sky[2 * stride + k]}
                                          : at(vertices_.base_color, next[k]) * at(vertices_.arriving, next[k]);
    const Vec2f env = env_brdf_at(look.env_table, max(dot(met[k].normal, met[k].to_camera), kGrazing));
    for (int c = 0; c < 3; ++c)
      out[k][c] = (1 - m) * diffuse[c] + ((m * color[c] + dielectric) * env.x + env.y) * reflected[c];
  }
  return out;
}

std::vector<Lighting::Blocked> Lighting::blocked(std::span<const Hit> hits, const Look& look) const {
  std::vector<Blocked> out(hits.size());
  const LobeRays probes = cast(surface_, hits, look.probes);
  std::vector<Hit> near;
  std::vector<uint32_t> index;
  for (size_t i = 0; i < hits.size(); ++i)
    for (int k = 0; k < kProbes; ++k)
      if (probes.far[i * kProbes + k].t >= 0) {
        near.push_back(hits[i]);
        index.push_back(uint32_t(i));
        break;
      }
  const LobeRays rays = cast(surface_, near, look.lobe);
  std::vector<Hit> met;
  std::vector<uint32_t> owner;
  for (size_t k = 0; k < rays.far.size(); ++k) {
    if (rays.far[k].t < 0) continue;
    met.push_back(met_by(rays.origins[k], rays.directions[k], rays.far[k]));
    owner.push_back(index[k / kRays]);
  }
  const std::vector<Vec3f> radiance = shown(met, look);
  for (size_t k = 0; k < met.size(); ++k) {
    out[owner[k]].open -= 1.0f / kRays;
    out[owner[k]].seen += radiance[k] * (1.0f / kRays);
  }
  return out;
}

HitLight Lighting::light_at(std::span<const Hit> hits, const Material& material, const SeenColors& seen) const {
  const Mesh& mesh = surface_.mesh();
  const float roughness = max(material.roughness, kLeastRoughness);
  const bool own = roughness == max(material_.roughness, kLeastRoughness);
  const Look look(material, own ? env_table_ : env_brdf_table(roughness), seen);
  HitLight out;
  out.irradiance.resize(hits.size());
  out.reflected.resize(hits.size());
  out.openness.resize(hits.size());
  out.open_mirror.resize(hits.size());
  out.env.resize(hits.size());
  const LobePlanes lobes{lobe_planes_.data(), n_lobes_, padded_};
  parallel_ranges(int(hits.size()), kBlock, [&](int begin, int end) {
    Block b;
    for (int i = begin; i < end; ++i) {
      const Hit& h = hits[i];
      const Vec3f r = mirror_direction(h);
      const Vec3f soft = normalize(at_corners(mesh.normals, mesh.triangles[h.triangle], h.b1, h.b2));
      for (int c = 0; c < 3; ++c) {
        b.normals[size_t(c) * kBlock + i - begin] = soft[c];
        b.mirrors[size_t(c) * kBlock + i - begin] = r[c];
      }
    }
    const int n = (end - begin + kPanel - 1) / kPanel * kPanel;
    device_.launch<SgIrradiance>({lobes, kBlock, b.normals.data(), b.irradiance.data()}, n);
    SgReflection::Args reflection{lobes, {}, {}, kBlock, b.mirrors.data(), b.reflected.data()};
    set_reflection_lobe(roughness, reflection);
    device_.launch<SgReflection>(reflection, n);
    const std::vector<Blocked> way = blocked(hits.subspan(begin, end - begin), look);
    for (int i = begin; i < end; ++i) {
      const Hit& h = hits[i];
      const auto& t = mesh.triangles[h.triangle];
      const auto plane = [&](const std::vector<float>& p) {
        return Vec3f{p[i - begin], p[kBlock + i - begin], p[2 * kBlock + i - begin]};
      };
      out.openness[i] = at_corners(vertices_.openness, t, h.b1, h.b2);
      out.irradiance[i] = plane(b.irradiance) * out.openness[i] + at_corners(vertices_.bounce, t, h.b1, h.b2);
      out.open_mirror[i] = max(way[i - begin].open, 0.0f);
      out.reflected[i] = plane(b.reflected) * out.open_mirror[i] + way[i - begin].seen;
      out.env[i] = env_brdf_at(look.env_table, dot(h.normal, h.to_camera));
    }
  });
  return out;
}

// Adjoint of the free sky's reflection: dL/d(mirror direction) from dL/d(radiance along it).
std::vector<Vec3f> Lighting::mirror_slopes(std::span<const Hit> hits, std::span<const Vec3f> d_reflected) const {
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
    SgReflectionSlope::Args a{{lobe_planes_.data(), n_lobes_, padded_}, {},        {},
                              kBlock, mirrors.data(), up.data(), down.data()};
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
  const float dielectric = (1 - material_.metalness) * kDielectricF0 * material_.specular;
  std::vector<Vec3f> d_reflected(hits.size()), out(hits.size());
  for (size_t i = 0; i < hits.size(); ++i) {
    const float nv = dot(hits[i].normal, hits[i].to_camera);
    const Vec2f above = env_brdf_at(env_table_, nv + kStep), below = env_brdf_at(env_table_, nv - kStep);
    float d_nv = 0;
    for (int c = 0; c < 3; ++c) {
      const float f0 = material_.metalness * albedo[i][c] + dielectric;
      d_reflected[i][c] = d_radiance[i][c] * (f0 * light.env[i].x + light.env[i].y) * light.open_mirror[i];
      d_nv += d_radiance[i][c] * light.reflected[i][c] * (f0 * (above.x - below.x) + above.y - below.y) / (2 * kStep);
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
  return {irradiance[hit] * ((1 - m) / kPi), reflected[hit] * (m * env[hit].x),
          reflected[hit] * (dielectric * env[hit].x + env[hit].y)};
}

// The hits of one material, as a batch of their own.
struct Lighting::Group {
  std::vector<uint32_t> index;  // in the whole batch
  std::vector<Hit> hits;
};

void Lighting::shade_group(const Group& group, std::span<const Vec3f> albedo, const Material& material,
                           const SeenColors& seen, Shading& out) const {
  const HitLight light = light_at(group.hits, material, seen);
  for (size_t k = 0; k < group.index.size(); ++k) {
    const uint32_t i = group.index[k];
    const HitLight::Terms t = light.at(k, material);
    out.diffuse[i] = albedo[i] * t.diffuse_gain;
    out.specular[i] = albedo[i] * t.specular_gain + t.specular_floor;
  }
}

Shading Lighting::shade(std::span<const Hit> hits, const Appearance& appearance, const SeenColors& seen) const {
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
    if (!groups[m].hits.empty()) shade_group(groups[m], appearance.albedo, appearance.materials[m], seen, out);
  return out;
}

Shading Lighting::shade(std::span<const Hit> hits, std::span<const Vec3f> albedo) const {
  return shade(
      hits,
      Appearance{{albedo.begin(), albedo.end()}, std::vector<uint32_t>(hits.size(), 0), {material_}, {}});
}

}  // namespace cei3d

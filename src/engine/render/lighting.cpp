// SPDX-License-Identifier: Apache-2.0
#include "engine/render/lighting.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/compute/kernels/shade.h"
#include "core/math/tangents.h"
#include "engine/render/hit_reflection.h"
#include "engine/render/lobe_frames.h"
#include "engine/render/lobe_planes.h"
#include "engine/render/radiance_map.h"

namespace cei3d {
namespace {

constexpr int kBlock = 2048;  // hits per chunk: its planes stay in the second-level cache

// Planes of one chunk of hits.
template <int kRows>
struct Planes {
  std::vector<float> data = std::vector<float>(size_t(kRows) * kBlock, 0.0f);
  float* row(int r) { return data.data() + size_t(r) * kBlock; }
  void put(int r, size_t i, Vec3f v) { store_planes(row(r), kBlock, int(i), v); }
  Vec3f get(int r, size_t i) { return load_planes<float>(row(r), kBlock, int(i)); }
};

struct ReflectionOfHits {
  LobeFrames base{kBlock}, fresnel{kBlock};
  std::vector<float> share;  // of the base lobe

  explicit ReflectionOfHits(const HitBatch& batch) {
    for (size_t i = 0; i < batch.size(); ++i) {
      const SurfaceReflection<float> r = reflection_of(batch.hits[i], batch.materials[i]);
      base.put(i, in_room(batch.turned, i, r.base));
      fresnel.put(i, in_room(batch.turned, i, r.fresnel));
      share.push_back(r.share);
    }
  }
};

// albedo: empty where it is not needed.
Planes<ShadingRows::kRows> shading_points(const HitBatch& batch, std::span<const IncidentLight<float>> light,
                                          std::span<const Vec3f> albedo) {
  Planes<ShadingRows::kRows> p;
  for (size_t i = 0; i < batch.size(); ++i) {
    const Material& m = batch.materials[i];
    const ShadingPoint<float> point{albedo.empty() ? Vec3f{0, 0, 0} : albedo[i],
                                    m.roughness,
                                    m.specular,
                                    m.metalness,
                                    dot(batch.hits[i].normal, batch.hits[i].to_camera),
                                    light[i].irradiance(),
                                    light[i].reflected(),
                                    light[i].diffuse_light};
    ShadingRows::store_point(p.row(0), kBlock, int(i), point);
  }
  return p;
}

// dL/d(the points' members); batch: at most kBlock hits.
Planes<ShadingRows::kRows> shade_grad(const Device& device, const HitBatch& batch,
                                      std::span<const IncidentLight<float>> light,
                                      std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance) {
  Planes<ShadingRows::kRows> points = shading_points(batch, light, albedo), d_points;
  Planes<3> d_out;
  for (size_t i = 0; i < batch.size(); ++i) d_out.put(0, i, d_radiance[i]);
  device.launch<ShadeGrad>({.split_sum = split_sum_table(),
                            .stride = kBlock,
                            .points = points.row(0),
                            .d_diffuse = d_out.row(0),
                            .d_specular = d_out.row(0),
                            .d_points = d_points.row(0)},
                           padded_to_panels(int(batch.size())));
  return d_points;
}

template <class T>
void put(const std::vector<T>& part, size_t first, std::vector<T>& out) {
  std::copy(part.begin(), part.end(), out.begin() + std::ptrdiff_t(first));
}
void put(const ShadingGrads& part, size_t first, ShadingGrads& out) {
  put(part.d_albedo, first, out.d_albedo);
  put(part.d_normal, first, out.d_normal);
  put(part.d_view, first, out.d_view);
  put(part.d_material, first, out.d_material);
  put(part.d_sky_irradiance, first, out.d_sky_irradiance);
  put(part.d_sky_reflection, first, out.d_sky_reflection);
}

std::shared_ptr<const Transport> or_new(std::shared_ptr<const Transport> transport,
                                        const std::shared_ptr<const Surface>& surface) {
  return transport ? transport : std::make_shared<const Transport>(surface);
}

VertexMaterials uniform_materials(std::span<const Vec3f> albedo, const Material& material) {
  return {{albedo.begin(), albedo.end()}, std::vector<Material>(albedo.size(), material)};
}

}  // namespace

Lighting::Lighting(const Device& device, std::shared_ptr<const Surface> surface, const SgMixture& light,
                   std::vector<VertexLight> by_bin)
    : device_(device), surface_(std::move(surface)), vertices_(std::move(by_bin)) {
  set_lobes(light);
  radiance_ = radiance_map(device_, lobes());
  directions_ = light_directions(sky_radiance(light));
}

Lighting::Lighting(const Device& device, std::shared_ptr<const Surface> surface, const SgMixture& light,
                   VertexLight vertices)
    : Lighting(device, std::move(surface), light, std::vector<VertexLight>{std::move(vertices)}) {}

Lighting::Lighting(const Device& device, std::shared_ptr<const Surface> surface, const SgMixture& light,
                   std::span<const Vec3f> albedo, const Material& material,
                   std::shared_ptr<const Transport> transport)
    : Lighting(
          device, surface, light,
          vertex_light(*or_new(std::move(transport), surface), light, uniform_materials(albedo, material))) {}

void Lighting::set_lobes(const SgMixture& light) {
  n_lobes_ = int(light.lobes.size());
  padded_ = padded_to_panels(n_lobes_);
  lobe_planes_ = lobe_planes(light);
  irradiance_ = IrradianceMap(device_, lobes());
}

namespace {

Planes<3> sky_along(const Device& device, const LobePlanes& light, const LobeFrames& lobes, size_t hits) {
  Planes<3> out;
  device.launch<SgReflection>({.lobes = light, .stride = kBlock, .points = lobes.planes(), .out = out.row(0)},
                              padded_to_panels(int(hits)));
  return out;
}

// dL/d(the frame of every lobe) from dL/d(radiance along it), times `share` of each hit.
LobeFrames frames_grad(const Device& device, const LobePlanes& light, const LobeFrames& lobes,
                       std::span<const Vec3f> d_radiance, const std::vector<float>& share) {
  LobeFrames d(kBlock);
  Planes<3> d_reflected;
  for (size_t i = 0; i < share.size(); ++i) d_reflected.put(0, i, d_radiance[i] * share[i]);
  device.launch<SgReflectionGrad>({.lobes = light,
                                   .stride = kBlock,
                                   .points = lobes.planes(),
                                   .d_reflected = d_reflected.row(0),
                                   .d_axes = d.axes(),
                                   .d_across = d.across(),
                                   .d_normals = d.normals(),
                                   .d_roughness = d.roughness(),
                                   .d_stretch = d.stretch()},
                                  padded_to_panels(int(share.size())));
  return d;
}

std::vector<float> rest_of(std::vector<float> share) {
  for (float& s : share) s = 1 - s;
  return share;
}

}  // namespace

// batch: at most kBlock hits.
std::vector<Vec3f> Lighting::sky_reflection(const HitBatch& batch) const {
  const ReflectionOfHits in(batch);
  Planes<3> base = sky_along(device_, lobes(), in.base, batch.size()),
            fresnel = sky_along(device_, lobes(), in.fresnel, batch.size());
  std::vector<Vec3f> radiance(batch.size());
  for (size_t i = 0; i < radiance.size(); ++i)
    radiance[i] = mean_of_lobes(in.share[i], base.get(0, i), fresnel.get(0, i));
  return radiance;
}

DiffuseLight<float> Lighting::diffuse_light(const HitBatch& batch, size_t hit) const {
  const Hit& h = batch.hits[hit];
  if (!surface_) return even_light(clamp(dot(h.normal, h.to_camera), 0.0f, 1.0f));
  return directions_.at(batch.turned.in_room(hit, h.normal)).towards(batch.turned.in_room(hit, h.to_camera));
}

void Lighting::add_diffuse_light_grad(const HitBatch& batch, size_t hit, const DiffuseLight<float>& d,
                                      Vec3f& d_normal, Vec3f& d_view) const {
  constexpr float kStep = 0.02f;  // step of differences: the table changes slowly
  const Vec3f n = batch.turned.in_room(hit, batch.hits[hit].normal),
              v = batch.turned.in_room(hit, batch.hits[hit].to_camera);
  const float nv = dot(n, v);
  Vec3f d_n{0, 0, 0}, d_v{0, 0, 0};
  if (surface_) {
    const auto loss_at = [&](Vec3f normal) {
      const DiffuseLight<float> light = directions_.at(normalize(normal)).towards(v);
      return light.lv * d.lv + light.grazing * d.grazing + light.grazing_lv * d.grazing_lv;
    };
    const auto derivative_along = [&](Vec3f direction) {
      return (loss_at(n + direction * kStep) - loss_at(n - direction * kStep)) / (2 * kStep);
    };
    const Tangents<float> t = tangents_of(n);
    const LightDirection light = directions_.at(n);
    d_n = t.x * derivative_along(t.x) + t.y * derivative_along(t.y);
    d_v = light.mean * d.lv + light.grazing_mean * d.grazing_lv;
    d_v += v * -dot(v, d_v);
  } else if (nv > 0 && nv < 1) {
    d_n = (v - n * nv) * even_light_grad(d);
    d_v = (n - v * nv) * even_light_grad(d);
  }
  d_normal += batch.turned.in_object(hit, d_n);
  d_view += batch.turned.in_object(hit, d_v);
}

IncidentLight<float> Lighting::incident_at(const HitBatch& batch, size_t hit, Vec3f sky_reflection,
                                           const SelfReflection::Reflected& seen) const {
  const Mesh& mesh = surface_->mesh();
  const Hit& h = batch.hits[hit];
  const auto& t = mesh.triangles[h.triangle];
  const VertexLight& vertices = vertices_[batch.turned.bin(hit)];
  const Vec3f normal = hit_normals_ ? h.normal : normalize(at_corners(mesh.normals, t, h.b1, h.b2));
  return {.sky_irradiance = irradiance_.at(batch.turned.in_room(hit, normal)),
          .visibility = at_corners(vertices.visibility, t, h.b1, h.b2),
          .bounce = at_corners(vertices.bounce, t, h.b1, h.b2),
          .sky_reflection = sky_reflection,
          .mirror_visibility = seen.visibility,
          .object_reflection = seen.radiance,
          .diffuse_light = diffuse_light(batch, hit)};
}

std::vector<IncidentLight<float>> Lighting::incident_light(const HitBatch& batch,
                                                           const VertexMaterials& seen) const {
  std::vector<IncidentLight<float>> out(batch.size());
  const SelfReflection own(device_, *surface_, vertices_, lobes(), radiance_,
                           seen.empty() ? vertices_.front().made_of : seen);
  parallel_ranges(int(batch.size()), kBlock, [&](int begin, int end) {
    const HitBatch part = batch.part(begin, end);
    const std::vector<Vec3f> sky = sky_reflection(part);
    const std::vector<SelfReflection::Reflected> object = own.seen_by(part);
    for (size_t i = 0; i < part.size(); ++i) out[size_t(begin) + i] = incident_at(part, i, sky[i], object[i]);
  });
  return out;
}

std::vector<IncidentLight<float>> Lighting::unoccluded_light(const HitBatch& batch) const {
  const Vec3f all{1, 1, 1}, none{0, 0, 0};
  std::vector<IncidentLight<float>> out(batch.size());
  parallel_ranges(int(batch.size()), kBlock, [&](int begin, int end) {
    const HitBatch part = batch.part(begin, end);
    const std::vector<Vec3f> sky = sky_reflection(part);
    for (size_t i = 0; i < part.size(); ++i)
      out[size_t(begin) + i] = {.sky_irradiance = irradiance_.at(part.turned.in_room(i, part.hits[i].normal)),
                                .visibility = all,
                                .bounce = none,
                                .sky_reflection = sky[i],
                                .mirror_visibility = all,
                                .object_reflection = none,
                                .diffuse_light = diffuse_light(part, i)};
  });
  return out;
}

std::vector<ShadingTerms<float>> Lighting::terms(const HitBatch& batch,
                                                 std::span<const IncidentLight<float>> light) const {
  std::vector<ShadingTerms<float>> out(batch.size());
  parallel_ranges(int(batch.size()), kBlock, [&](int begin, int end) {
    const HitBatch part = batch.part(begin, end);
    Planes<ShadingRows::kRows> points = shading_points(part, light.subspan(size_t(begin), part.size()), {});
    Planes<Shade::kOutputs> terms;
    device_.launch<Shade>({split_sum_table(), kBlock, points.row(0), terms.row(0)},
                          padded_to_panels(int(part.size())));
    for (size_t i = 0; i < part.size(); ++i)
      out[size_t(begin) + i] = {terms.get(0, i), terms.get(3, i), terms.get(6, i)};
  });
  return out;
}

std::vector<ShadingTerms<float>> Lighting::terms(const HitBatch& batch, const VertexMaterials& seen) const {
  constexpr int kSlab = 64 * kBlock;  // bounds the memory that incident light takes
  std::vector<ShadingTerms<float>> out;
  out.reserve(batch.size());
  for (int begin = 0; begin < int(batch.size()); begin += kSlab) {
    const HitBatch part = batch.part(begin, std::min(begin + kSlab, int(batch.size())));
    const std::vector<ShadingTerms<float>> some = terms(part, incident_light(part, seen));
    out.insert(out.end(), some.begin(), some.end());
  }
  return out;
}

Shading shading_of(std::span<const ShadingTerms<float>> terms, std::span<const Vec3f> albedo) {
  Shading out{std::vector<Vec3f>(terms.size()), std::vector<Vec3f>(terms.size())};
  for (size_t i = 0; i < terms.size(); ++i) {
    out.diffuse[i] = terms[i].diffuse(albedo[i]);
    out.specular[i] = terms[i].specular(albedo[i]);
  }
  return out;
}

Shading Lighting::shade(const HitBatch& batch, std::span<const Vec3f> albedo,
                        const VertexMaterials& seen) const {
  return shading_of(terms(batch, seen), albedo);
}

std::vector<SurfaceReflectionGrad<float>> Lighting::reflection_grad(
    const HitBatch& batch, std::span<const Vec3f> d_reflection) const {
  const ReflectionOfHits in(batch);
  Planes<3> base = sky_along(device_, lobes(), in.base, batch.size()),
            fresnel = sky_along(device_, lobes(), in.fresnel, batch.size());
  const LobeFrames d_base = frames_grad(device_, lobes(), in.base, d_reflection, in.share),
                   d_fresnel = frames_grad(device_, lobes(), in.fresnel, d_reflection, rest_of(in.share));
  std::vector<SurfaceReflectionGrad<float>> out;
  for (size_t i = 0; i < batch.size(); ++i) {
    const Material& m = batch.materials[i];
    const SurfaceReflection<float> d{in_object(batch.turned, i, d_base.get(i)),
                                     in_object(batch.turned, i, d_fresnel.get(i)),
                                     dot(d_reflection[i], base.get(0, i) - fresnel.get(0, i))};
    out.push_back(surface_reflection_grad(reflection_tables(), batch.hits[i].normal, batch.hits[i].to_camera,
                                          m.roughness, m.specular, m.metalness, d));
  }
  return out;
}

ShadingGrads Lighting::block_grad(const HitBatch& batch, std::span<const IncidentLight<float>> light,
                                  std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance) const {
  using Rows = ShadingRows;
  Planes<Rows::kRows> d_points = shade_grad(device_, batch, light, albedo, d_radiance);
  ShadingGrads out(batch.size());
  for (size_t i = 0; i < batch.size(); ++i) {
    const IncidentLight<float> d =
        incident_light_grad(light[i], d_points.get(Rows::kIrradiance, i), d_points.get(Rows::kReflected, i));
    out.d_albedo[i] = d_points.get(Rows::kAlbedo, i);
    out.d_sky_irradiance[i] = d.sky_irradiance;
    out.d_sky_reflection[i] = d.sky_reflection;
  }
  const std::vector<SurfaceReflectionGrad<float>> reflection = reflection_grad(batch, out.d_sky_reflection);
  for (size_t i = 0; i < batch.size(); ++i) {
    const Vec3f n = batch.hits[i].normal, v = batch.hits[i].to_camera;
    const float d_nv = d_points.row(Rows::kNv)[i], nv = dot(n, v);
    const SurfaceReflectionGrad<float>& r = reflection[i];
    out.d_normal[i] = (v - n * nv) * d_nv + r.d_n;
    if (hit_normals_)
      out.d_normal[i] +=
          batch.turned.in_object(i, irradiance_.grad(batch.turned.in_room(i, n), out.d_sky_irradiance[i]));
    out.d_view[i] = (n - v * nv) * d_nv + r.d_v;
    add_diffuse_light_grad(batch, i,
                           {d_points.row(Rows::kDiffuseLight)[i], d_points.row(Rows::kDiffuseLight + 1)[i],
                            d_points.row(Rows::kDiffuseLight + 2)[i]},
                           out.d_normal[i], out.d_view[i]);
    out.d_material[i] = {d_points.row(Rows::kRoughness)[i] + r.d_roughness,
                         d_points.row(Rows::kSpecular)[i] + r.d_specular,
                         d_points.row(Rows::kMetalness)[i] + r.d_metalness};
  }
  return out;
}

ShadingGrads Lighting::grad(const HitBatch& batch, std::span<const IncidentLight<float>> light,
                            std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance) const {
  ShadingGrads out(batch.size());
  parallel_ranges(int(batch.size()), kBlock, [&](int begin, int end) {
    const HitBatch part = batch.part(begin, end);
    const size_t first = size_t(begin), n = part.size();
    put(block_grad(part, light.subspan(first, n), albedo.subspan(first, n), d_radiance.subspan(first, n)),
        first, out);
  });
  return out;
}

}  // namespace cei3d

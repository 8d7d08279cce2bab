// SPDX-License-Identifier: Apache-2.0
#include "engine/export/bake.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/parallel.h"
#include "core/math/color.h"
#include "engine/export/fill_empty.h"
#include "engine/export/sky_share.h"
#include "engine/export/surface_below.h"
#include "engine/export/tangents.h"
#include "model/geometry/unwrap/raster.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

constexpr size_t kChunk = 1 << 17;  // samples

// Where a texel, or a part of it, lies on the mesh.
struct Sample {
  uint32_t texel, triangle;
  float b1, b2;
};

struct Texel {
  Vec3f albedo, normal;  // linear; unit frame
  float sky, roughness, metalness, specular;
};
Texel operator+(const Texel& a, const Texel& b) {
  return {a.albedo + b.albedo,       a.normal + b.normal,       a.sky + b.sky,
          a.roughness + b.roughness, a.metalness + b.metalness, a.specular + b.specular};
}
Texel operator*(const Texel& a, float s) {
  return {a.albedo * s, a.normal * s, a.sky * s, a.roughness * s, a.metalness * s, a.specular * s};
}

class Baker {
 public:
  Baker(const Device& device, const Scene& scene, const TexturedMesh& mesh, const BakeOptions& o)
      : device_(device), scene_(scene), mesh_(mesh), options_(o), sky_(sky_shares(*scene.surface)) {
    const size_t texels = size_t(o.size) * o.size;
    texels_.resize(texels);
    known_.assign(texels, 0);
    samples_.reserve(texels);
  }

  Textures run(Progress& progress) {
    find_samples();
    for (size_t i = 0; i < samples_.size(); i += kChunk) {
      check_cancelled(progress, "The export was interrupted; nothing was written.");
      progress.report({"textures", 0.3 + 0.4 * double(i) / double(samples_.size()), -1, ""});
      const auto chunk = std::span(samples_).subspan(i, std::min(kChunk, samples_.size() - i));
      look_at(chunk, [&](const Sample& s, const Texel& t) { texels_[s.texel] = t, known_[s.texel] = 1; });
    }
    supersample(progress);
    return textures();
  }

 private:
  Vec2f corner(uint32_t v) const { return mesh_.uv[v] * float(options_.size); }

  void find_samples() {
    std::vector<uint8_t> taken(texels_.size(), 0);
    for (uint32_t f = 0; f < mesh_.triangles.size(); ++f) {
      const auto [a, b, c] = mesh_.triangles[f];
      for_each_texel(corner(a), corner(b), corner(c), options_.size, options_.size,
                     [&](int x, int y, float b1, float b2) {
                       const size_t texel = size_t(y) * options_.size + x;
                       if (taken[texel]) return;  // on an edge
                       taken[texel] = 1;
                       samples_.push_back({uint32_t(texel), f, b1, b2});
                     });
    }
  }

  // Calls use(sample, what the surface is like there) for the samples that have surface near them.
  template <class Use>
  void look_at(std::span<const Sample> samples, const Use& use) const {
    std::vector<Vec3f> points, normals;
    for (const Sample& s : samples) {
      const auto& t = mesh_.triangles[s.triangle];
      points.push_back(at_corners(mesh_.positions, t, s.b1, s.b2));
      normals.push_back(normalize(at_corners(mesh_.normals, t, s.b1, s.b2)));
    }
    const SurfaceBelow below = surface_below(device_, scene_, points, normals, options_.reach);
    const Appearance look = appearance_at(device_, scene_, below.hits);
    for (size_t i = 0; i < below.hits.size(); ++i) {
      const Hit& h = below.hits[i];
      const auto& t = scene_.surface->mesh().triangles[h.triangle];
      const Material& m = look.material[i];
      const float sky = at_corners(sky_, t, h.b1, h.b2);
      use(samples[below.of_point[i]],
          Texel{look.albedo[i], h.normal, sky, m.roughness, m.metalness, m.specular});
    }
  }

  static bool differ(const Texel& a, const Texel& b) {
    constexpr float kColor = 0.03f, kTurn = 0.995f, kMaterial = 0.03f;
    const Vec3f d = srgb_from_linear(a.albedo) - srgb_from_linear(b.albedo);
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) > kColor ||
           dot(a.normal, b.normal) < kTurn || std::abs(a.roughness - b.roughness) > kMaterial ||
           std::abs(a.metalness - b.metalness) > kMaterial || std::abs(a.specular - b.specular) > kMaterial;
  }

  bool differs_from_a_neighbor(uint32_t texel) const {
    const int n = options_.size, x = int(texel) % n, y = int(texel) / n;
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      if (x + dx < 0 || x + dx >= n || y + dy < 0 || y + dy >= n) continue;
      const size_t other = size_t(y + dy) * n + x + dx;
      if (known_[other] && differ(texels_[texel], texels_[other])) return true;
    }
    return false;
  }

  // The four quarters of a texel, those that lie in its triangle.
  void add_quarters(const Sample& s, std::vector<Sample>& out) const {
    const auto [a, b, c] = mesh_.triangles[s.triangle];
    const Vec2f p = corner(a), e = corner(b) - p, g = corner(c) - p;
    const Vec2f center{float(s.texel % options_.size) + 0.5f - p.x,
                       float(s.texel / options_.size) + 0.5f - p.y};
    for (const float dy : {-0.25f, 0.25f})
      for (const float dx : {-0.25f, 0.25f}) {
        const auto [b1, b2] = barycentrics_in(e, g, center + Vec2f{dx, dy});
        if (std::min({b1, b2, 1 - b1 - b2}) >= 0) out.push_back({s.texel, s.triangle, b1, b2});
      }
  }

  void supersample(Progress& progress) {
    std::vector<Sample> quarters;
    for (const Sample& s : samples_)
      if (known_[s.texel] && differs_from_a_neighbor(s.texel)) add_quarters(s, quarters);
    for (size_t i = 0; i < quarters.size();) {
      check_cancelled(progress, "The export was interrupted; nothing was written.");
      progress.report({"textures", 0.7 + 0.2 * double(i) / double(quarters.size()), -1, ""});
      size_t end = std::min(i + kChunk, quarters.size());
      while (end < quarters.size() && quarters[end].texel == quarters[end - 1].texel) ++end;
      replace_by_means(std::span(quarters).subspan(i, end - i));
      i = end;
    }
  }

  void replace_by_means(std::span<const Sample> quarters) {
    uint32_t open = ~0u;
    Texel sum{};
    int n = 0;
    const auto close = [&] {
      if (n > 0) texels_[open] = sum * (1 / float(n));
      if (n > 0) texels_[open].normal = normalize(texels_[open].normal);
    };
    look_at(quarters, [&](const Sample& s, const Texel& t) {
      if (s.texel != open) {
        close();
        open = s.texel, sum = t, n = 1;
      } else {
        sum = sum + t, ++n;
      }
    });
    close();
  }

  Vec3f normal_value(const Sample& s) const {
    const auto& t = mesh_.triangles[s.triangle];
    const TangentFrame frame{at_corners(mesh_.tangents, t, s.b1, s.b2),
                             at_corners(mesh_.normals, t, s.b1, s.b2)};
    Vec3f c = frame.coordinates(texels_[s.texel].normal);
    constexpr float kSteepest = 0.02f;  // glTF's normals look out of the surface
    c.z = max(c.z, kSteepest);
    return normalize(c) * 0.5f + Vec3f{0.5f, 0.5f, 0.5f};
  }

  Textures textures() const {
    const int n = options_.size;
    Textures out{Image(n, n, 3), Image(n, n, 3), Image(n, n, 3), Image(n, n, 1), 0.5f};
    const auto put = [](float* at, Vec3f v) { at[0] = v.x, at[1] = v.y, at[2] = v.z; };
    parallel_ranges(int(samples_.size()), 1 << 16, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const uint32_t p = samples_[i].texel;
        if (!known_[p]) continue;
        const Texel& t = texels_[p];
        put(&out.base_color.data[3 * size_t(p)], t.albedo);
        put(&out.orm.data[3 * size_t(p)], {t.sky, t.roughness, t.metalness});
        put(&out.normal.data[3 * size_t(p)], normal_value(samples_[i]));
        out.specular.data[p] = t.specular;
      }
    });
    for (Image* image : {&out.base_color, &out.orm, &out.normal, &out.specular}) fill_empty(*image, known_);
    simplify_specular(out);
    return out;
  }

  static void simplify_specular(Textures& out) {
    const auto [low, high] = std::minmax_element(out.specular.data.begin(), out.specular.data.end());
    out.middle_specular = (*low + *high) / 2;
    constexpr float kSame = 1 / 512.0f;
    if (*high - *low < kSame) out.specular = Image();
  }

  const Device& device_;
  const Scene& scene_;
  const TexturedMesh& mesh_;
  const BakeOptions options_;
  std::vector<float> sky_;
  std::vector<Sample> samples_;
  std::vector<Texel> texels_;
  Area known_;
};

}  // namespace

Textures bake(const Device& device, const Scene& scene, const TexturedMesh& mesh, const BakeOptions& options,
              Progress& progress) {
  return Baker(device, scene, mesh, options).run(progress);
}

}  // namespace cei3d

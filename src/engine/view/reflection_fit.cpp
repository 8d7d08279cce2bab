// SPDX-License-Identifier: Apache-2.0
#include "engine/view/reflection_fit.h"

#include <Eigen/Dense>
#include <cmath>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/fibonacci.h"
#include "core/math/mirror.h"
#include "engine/view/pack.h"
#include "engine/view/quantize.h"

namespace cei3d {
namespace {

constexpr int kViews = 48;           // directions of view on the sphere; about half are above a horizon
constexpr float kMinCosine = 0.08f;  // minimum cosine of normal and view
constexpr size_t kBlock = 1024;      // vertices that are shaded together
constexpr float kRidge = 1e-3f;      // relative: keeps the terms small that no view determines

constexpr int kTerms = int(kVisibilityTerms), kValues = 4;  // hidden share, radiance
using Matrix = Eigen::Matrix<float, kTerms, kTerms>;
using Values = Eigen::Matrix<float, kTerms, kValues>;

bool sees_whole_sky(const Surface& surface, uint32_t vertex) {
  const std::vector<Vec3f>& sky = sky_directions();
  for (int k = 0; k < kSkyDirections; ++k)
    if (dot(sky[size_t(k)], surface.mesh().normals[vertex]) > 0 && !surface.sees(vertex, k)) return false;
  return true;
}

// Least squares over directions of view, by their cosine: as much of a picture is seen from them.
class Fit {
 public:
  void add(const Hit& h, const IncidentLight<float>& light) {
    const VisibilityTerms basis = visibility_basis(mirrored_direction(h.normal, h.to_camera));
    const Eigen::Map<const Eigen::Matrix<float, kTerms, 1>> b(basis.data());
    const float weight = dot(h.normal, h.to_camera);
    const Vec3f s = light.object_reflection;
    const Eigen::Matrix<float, 1, kValues> values(1 - luminance(light.mirror_visibility), s.x, s.y, s.z);
    matrix_ += weight * b * b.transpose();
    right_ += weight * b * values;
  }
  ReflectionFit solved() const {
    Matrix m = matrix_;
    m.diagonal().array() += kRidge * m.trace() / kTerms;
    const Values x = m.ldlt().solve(right_);
    ReflectionFit fit;
    for (int k = 0; k < kTerms; ++k) {
      fit.visibility[size_t(k)] = (k == 0 ? 1.0f : 0.0f) - x(k, 0);
      fit.object[size_t(k)] = {x(k, 1), x(k, 2), x(k, 3)};
    }
    return fit;
  }

 private:
  Matrix matrix_ = Matrix::Zero();
  Values right_ = Values::Zero();
};

// Fits of some of the view's vertices.
void fit_block(const Lighting& lighting, std::span<const Hit> of_vertices, const VertexMaterials& seen,
               const ViewMesh& view, std::span<const uint32_t> which, std::vector<ReflectionFit>& out) {
  std::vector<Hit> hits;
  std::vector<Material> materials;
  std::vector<size_t> end;
  for (const uint32_t i : which) {
    Hit h = of_vertices[view.vertices[i]];
    for (int k = 0; k < kViews; ++k) {
      h.to_camera = fibonacci_direction(k, kViews);
      if (dot(h.normal, h.to_camera) < kMinCosine) continue;
      hits.push_back(h);
      materials.push_back(seen.material[view.vertices[i]]);
    }
    end.push_back(hits.size());
  }
  const std::vector<IncidentLight<float>> light = lighting.incident_light({hits, materials}, seen);
  parallel_ranges(int(which.size()), 64, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      Fit fit;
      for (size_t k = i > 0 ? end[size_t(i) - 1] : 0; k < end[size_t(i)]; ++k) fit.add(hits[k], light[k]);
      out[which[size_t(i)]] = fit.solved();
    }
  });
}

}  // namespace

std::vector<ReflectionFit> reflection_fits(const Lighting& lighting, const Surface& surface,
                                           const ViewMesh& view, const Appearance& look) {
  std::vector<ReflectionFit> out(view.vertices.size());
  std::vector<uint32_t> partly;
  for (uint32_t i = 0; i < view.vertices.size(); ++i)
    if (!sees_whole_sky(surface, view.vertices[i])) partly.push_back(i);
  const std::vector<Hit> hits = vertex_hits(surface.mesh());
  const VertexMaterials seen{look.albedo, look.material};
  for (size_t begin = 0; begin < partly.size(); begin += kBlock)
    fit_block(lighting, hits, seen, view,
              std::span(partly).subspan(begin, std::min(kBlock, partly.size() - begin)), out);
  return out;
}

std::string view_reflections(const std::vector<ReflectionFit>& fits) {
  const auto largest_of = [](const ReflectionFit& f) {
    float largest = 0;
    for (const Vec3f& t : f.object)
      for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(t[c]));
    return largest;
  };
  std::vector<VisibilityTerms> visibility;
  float all = 1e-6f;
  for (const ReflectionFit& f : fits) {
    visibility.push_back(f.visibility);
    all = std::max(all, largest_of(f));
  }
  std::vector<int8_t> object;
  for (const ReflectionFit& f : fits) {
    const int8_t root = int8_t(std::ceil(127 * std::sqrt(largest_of(f) / all)));
    const float scale = std::max(square(float(root) / 127) * all, 1e-12f);
    for (const Vec3f& t : f.object)
      for (int c = 0; c < 3; ++c) object.push_back(snorm8(t[c] / scale));
    object.push_back(root);
  }
  Pack pack("reflections");
  add_visibility(visibility, pack);
  pack["object_scale"] = all;
  pack.add("object", object, 3 * kVisibilityTerms + 1);
  return pack.bytes();
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/reshape.h"

#include <algorithm>
#include <cstring>

#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {
namespace {

bool ascends_below(const std::vector<uint32_t>& ids, size_t end) {
  return std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end() &&
         (ids.empty() || ids.back() < end);
}

void check_fit(const Mesh& mesh, const Reshape& r) {
  const size_t moved = r.moved.size(), added = r.added_positions.size();
  const size_t old = mesh.positions.size();
  const bool whole = r.positions.size() == moved && r.normals.size() == moved &&
                     r.gradients.size() == moved && r.added_normals.size() == added &&
                     r.added_colors.size() == added && r.rim_colors.size() == r.rim.size();
  const bool named = std::all_of(r.added_triangles.begin(), r.added_triangles.end(), [&](const auto& t) {
    return std::all_of(t.begin(), t.end(), [&](uint32_t v) {
      return v < old ? std::binary_search(r.rim.begin(), r.rim.end(), v) : v - old < added;
    });
  });
  if (!whole || !named || mesh.normals.size() != old || !ascends_below(r.moved, old) ||
      !ascends_below(r.rim, old) || !ascends_below(r.removed, mesh.triangles.size()))
    fail(
        "A change of shape does not fit the surface that it should change. Toggle it off, or make it again.");
}

Tensor gradients_tensor(const std::vector<std::array<float, 9>>& gradients) {
  Tensor t{{int64_t(gradients.size()), 9}, std::vector<float>(9 * gradients.size()), {}};
  if (!gradients.empty()) std::memcpy(t.f32.data(), gradients.data(), t.f32.size() * sizeof(float));
  return t;
}

std::vector<std::array<float, 9>> gradients_from(const Tensors& in, int64_t rows) {
  const Tensor& t = require_tensor(in, "reshape/gradients", {rows, 9});
  std::vector<std::array<float, 9>> out(static_cast<size_t>(rows));
  if (!out.empty()) std::memcpy(out.data(), t.f32.data(), t.f32.size() * sizeof(float));
  return out;
}

}  // namespace

Mesh apply(const Mesh& mesh, const Reshape& r) {
  check_fit(mesh, r);
  Mesh out = mesh;
  for (size_t i = 0; i < r.moved.size(); ++i) {
    out.positions[r.moved[i]] = r.positions[i];
    out.normals[r.moved[i]] = r.normals[i];
  }
  out.positions.insert(out.positions.end(), r.added_positions.begin(), r.added_positions.end());
  out.normals.insert(out.normals.end(), r.added_normals.begin(), r.added_normals.end());
  if (!out.colors.empty()) out.colors.insert(out.colors.end(), r.added_colors.begin(), r.added_colors.end());
  out.triangles.clear();
  for (const uint32_t t : kept_triangles(mesh, r)) out.triangles.push_back(mesh.triangles[t]);
  out.triangles.insert(out.triangles.end(), r.added_triangles.begin(), r.added_triangles.end());
  return out;
}

std::vector<uint32_t> kept_triangles(const Mesh& before, const Reshape& r) {
  std::vector<uint32_t> kept;
  auto gone = r.removed.begin();
  for (uint32_t t = 0; t < before.triangles.size(); ++t) {
    if (gone != r.removed.end() && *gone == t)
      ++gone;
    else
      kept.push_back(t);
  }
  return kept;
}

void save_reshape(const Reshape& r, Tensors& tensors, Json& head) {
  head = {{"moved", r.moved.size()},
          {"removed", r.removed.size()},
          {"added_vertices", r.added_positions.size()},
          {"added_triangles", r.added_triangles.size()},
          {"rim", r.rim.size()}};
  tensors["reshape/moved"] = tensor_of(std::span(r.moved));
  tensors["reshape/positions"] = tensor_of(std::span(r.positions));
  tensors["reshape/normals"] = tensor_of(std::span(r.normals));
  tensors["reshape/gradients"] = gradients_tensor(r.gradients);
  tensors["reshape/removed"] = tensor_of(std::span(r.removed));
  tensors["reshape/added_positions"] = tensor_of(std::span(r.added_positions));
  tensors["reshape/added_normals"] = tensor_of(std::span(r.added_normals));
  tensors["reshape/added_colors"] = tensor_of(std::span(r.added_colors));
  tensors["reshape/added_triangles"] = tensor_of(std::span(r.added_triangles));
  tensors["reshape/rim"] = tensor_of(std::span(r.rim));
  tensors["reshape/rim_colors"] = tensor_of(std::span(r.rim_colors));
}

Reshape load_reshape(const Tensors& tensors, const Json& head, const std::string& what) {
  JsonReader reader(head, what);
  const int64_t moved = rows_from(reader.member("moved")), added = rows_from(reader.member("added_vertices")),
                removed = rows_from(reader.member("removed")),
                added_triangles = rows_from(reader.member("added_triangles")),
                rim = rows_from(reader.member("rim"));
  reader.finish();
  Reshape r;
  r.moved = numbers_from(tensors, "reshape/moved", moved);
  r.positions = vectors_from(tensors, "reshape/positions", moved);
  r.normals = vectors_from(tensors, "reshape/normals", moved);
  r.gradients = gradients_from(tensors, moved);
  r.removed = numbers_from(tensors, "reshape/removed", removed);
  r.added_positions = vectors_from(tensors, "reshape/added_positions", added);
  r.added_normals = vectors_from(tensors, "reshape/added_normals", added);
  r.added_colors = vectors_from(tensors, "reshape/added_colors", added);
  r.added_triangles = triangles_from(tensors, "reshape/added_triangles", added_triangles);
  r.rim = numbers_from(tensors, "reshape/rim", rim);
  r.rim_colors = vectors_from(tensors, "reshape/rim_colors", rim);
  return r;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Charts laid flat.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "model/geometry/mesh/mesh.h"
#include "model/geometry/unwrap/conformal.h"
#include "model/geometry/unwrap/face_graph.h"
#include "model/geometry/unwrap/pack.h"

namespace cei3d {

// A chart laid flat.
struct FlatChart {
  std::vector<uint32_t> faces;   // of the mesh, ascending
  std::vector<uint32_t> vertex;  // #points, of the mesh
  FlatPiece flat;
  double stretch = 1;  // L2
};

// Lays out the faces of a mesh, one chart after the other. Both arguments must outlive it. texels_per_length:
// of the texture; overlaps are sought at twice that density.
class Flattener {
 public:
  Flattener(const Mesh& mesh, const FaceGraph& graph, double texels_per_length)
      : mesh_(mesh), graph_(graph), density_(texels_per_length) {}

  // One chart, or as many as it takes that none is flipped, overlaps itself or is stretched by more than
  // max_stretch (L2), appended to `out`.
  void flatten(std::vector<uint32_t> faces, double max_stretch, std::vector<FlatChart>& out) const;

  // The same for both halves of a chart.
  void flatten_halves(const std::vector<uint32_t>& faces, double max_stretch,
                      std::vector<FlatChart>& out) const;

  // Faces connected by edges as one chart; none: it would be flipped, overlap itself or be stretched more.
  std::optional<FlatChart> flat_in_one(std::vector<uint32_t> faces, double max_stretch) const;

 private:
  Patch2d patch_of(std::span<const uint32_t> faces, std::vector<uint32_t>& vertex) const;
  void join_across(std::span<const uint32_t> faces, uint32_t i, uint32_t k,
                   std::vector<uint32_t>& parent) const;
  bool overlaps_itself(const FlatPiece& piece) const;
  std::vector<std::vector<uint32_t>> halves(const std::vector<uint32_t>& faces) const;
  Vec3f longest_axis(const std::vector<uint32_t>& faces) const;

  const Mesh& mesh_;
  const FaceGraph& graph_;
  double density_;
};

}  // namespace cei3d

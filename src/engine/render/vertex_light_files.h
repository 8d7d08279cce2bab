// SPDX-License-Identifier: Apache-2.0
// The light at the vertices of a reconstructed shape on disk, as it takes about a second to compute. Files
// that are missing, damaged or cannot be written only cost that second.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/render/vertex_light.h"

namespace cei3d {

class VertexLightFiles {
 public:
  static constexpr size_t kMax = 8;  // files that are kept, the newest

  VertexLightFiles() = default;  // keeps nothing
  // object: a hash of the surface and of the materials of its vertices. Not writable: put() does nothing.
  VertexLightFiles(std::filesystem::path folder, std::string object, bool writable)
      : folder_(std::move(folder)), object_(std::move(object)), writable_(writable) {}

  bool has(const SgMixture&) const;
  // made_of: of the vertices.
  std::optional<VertexLight> find(const SgMixture&, const VertexMaterials& made_of) const;
  void put(const SgMixture&, const VertexLight&) const;

 private:
  std::filesystem::path file_of(const SgMixture&) const;

  std::filesystem::path folder_;
  std::string object_;
  bool writable_ = false;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/render/vertex_light_files.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/tensors.h"
#include "model/geometry/shape/vec_tensors.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPrefix = "vertex-light-";
constexpr int kVersion = 1;  // raise it when the same object and light give other values

// Error: not so many finite values.
std::vector<Vec3f> values_of(const Tensors& tensors, const char* name, size_t count) {
  std::vector<Vec3f> values = vectors_from(tensors, name, int64_t(count));
  for (const Vec3f& v : values)
    if (!std::isfinite(v.x + v.y + v.z)) fail("The light at the vertices is not finite.");
  return values;
}

void remove_oldest(const fs::path& folder, size_t keep) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with(kPrefix))
      files.emplace_back(it->last_write_time(error), it->path());
  std::sort(files.begin(), files.end());
  for (size_t i = 0; i + keep < files.size(); ++i) fs::remove(files[i].second, error);
}

}  // namespace

fs::path VertexLightFiles::file_of(const SgMixture& light) const {
  const std::vector<float> numbers = to_array(light);
  const std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  const std::string key = content_hash(fmt::format("{} {} ", kVersion, object_) + bytes);
  return folder_ / (kPrefix + key + ".safetensors");
}

bool VertexLightFiles::has(const SgMixture& light) const {
  std::error_code error;
  return !folder_.empty() && fs::exists(file_of(light), error);
}

std::optional<VertexLight> VertexLightFiles::find(const SgMixture& light,
                                                  const VertexMaterials& made_of) const {
  if (!has(light)) return std::nullopt;
  try {
    const Tensors tensors = read_tensors(file_of(light));
    const size_t n = made_of.albedo.size();
    return VertexLight{made_of, values_of(tensors, "visibility", n), values_of(tensors, "bounce", n),
                       values_of(tensors, "irradiance", n)};
  } catch (const Error&) {
    return std::nullopt;
  }
}

void VertexLightFiles::put(const SgMixture& light, const VertexLight& v) const {
  std::error_code error;
  if (!writable_ || fs::exists(file_of(light), error)) return;
  try {
    write_tensors(file_of(light), {{"visibility", tensor_of(v.visibility)},
                                   {"bounce", tensor_of(v.bounce)},
                                   {"irradiance", tensor_of(v.irradiance)}});
    remove_oldest(folder_, kMax);
  } catch (const Error&) {
    return;  // the folder cannot be written, or the disk is full
  }
}

}  // namespace cei3d

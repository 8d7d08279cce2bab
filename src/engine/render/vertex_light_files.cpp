// SPDX-License-Identifier: Apache-2.0
#include "engine/render/vertex_light_files.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/tensors.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPrefix = "vertex-light-";
constexpr int kVersion = 1;  // raise it when the same object and light give other values

Tensor tensor_of(const std::vector<Vec3f>& values) {
  Tensor t;
  t.shape = {int64_t(values.size()), 3};
  for (const Vec3f& v : values) t.f32.insert(t.f32.end(), {v.x, v.y, v.z});
  return t;
}

// Error: not so many finite values.
std::vector<Vec3f> values_of(const Tensors& tensors, const char* name, size_t count) {
  const auto it = tensors.find(name);
  if (it == tensors.end() || it->second.f32.size() != 3 * count)
    fail("The light at the vertices is of another object.");
  std::vector<Vec3f> out;
  const std::vector<float>& v = it->second.f32;
  for (size_t i = 0; i < v.size(); i += 3) {
    if (!std::isfinite(v[i] + v[i + 1] + v[i + 2])) fail("The light at the vertices is not finite.");
    out.push_back({v[i], v[i + 1], v[i + 2]});
  }
  return out;
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

std::optional<VertexLight> VertexLightFiles::find(const SgMixture& light,
                                                  const VertexMaterials& made_of) const {
  std::error_code error;
  if (folder_.empty() || !fs::exists(file_of(light), error)) return std::nullopt;
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
    remove_oldest(folder_, kMost);
  } catch (const Error&) {
    return;  // the folder cannot be written, or the disk is full
  }
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "model/field/sphere_start.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr int kDirections = 512;      // number of directions in which the sphere is measured
constexpr float kLastSpread = 1e-4f;  // standard deviation of the last weights

// from: first input whose weights are zero.
void draw(Param& weight, int from, float mean, float deviation, uint64_t seed, uint64_t layer) {
  const int64_t in = weight.shape[1];
  for (size_t i = 0; i < weight.count(); ++i)
    weight.value[i] = int64_t(i) % in < from ? mean + deviation * Rng(seed, 2000 + layer, i).normal() : 0.0f;
}

}  // namespace

void begin_as_sphere(const Device& device, Field& field, float radius, uint64_t seed) {
  const FieldConfig& config = field.config();
  if (config.sphere_radius > 0) return;
  const std::vector<MlpLayer> layers = mlp_layers(mlp_config(config));
  const int encoded = encoding_rows(config.encoding) - 3;
  for (size_t l = 0; l + 1 < layers.size(); ++l) {
    const bool reads_encoding = l == 0 || layers[l].concat;
    Param& weight = field.params().get("layer" + std::to_string(l) + "/weight");
    draw(weight, layers[l].in - (reads_encoding ? encoded : 0), 0, std::sqrt(2.0f / float(layers[l].out)),
         seed, l);
  }
  const std::string last = "layer" + std::to_string(layers.size() - 1);
  Param distance{"", {1, layers.back().in}, {}};
  distance.value.resize(size_t(layers.back().in));
  draw(distance, layers.back().in, std::sqrt(kPi / float(layers.back().in)), kLastSpread, seed,
       layers.size());
  std::copy(distance.value.begin(), distance.value.end(), field.params().get(last + "/weight").value.begin());
  std::vector<Vec3f> on_sphere;
  for (int i = 0; i < kDirections; ++i) on_sphere.push_back(fibonacci_direction(i, kDirections) * radius);
  double mean = 0;
  for (const float v : first_output(device, field, on_sphere)) mean += double(v) / kDirections;
  field.params().get(last + "/bias").value[0] -= float(mean);
}

}  // namespace cei3d

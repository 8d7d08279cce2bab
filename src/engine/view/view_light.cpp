// SPDX-License-Identifier: Apache-2.0
#include "engine/view/view_light.h"

#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/compute/kernels/shade.h"
#include "core/math/horizon.h"
#include "core/math/ladder.h"
#include "core/math/lobe_row.h"
#include "core/math/reflection_axis.h"
#include "core/math/roughness.h"
#include "core/math/sg.h"
#include "engine/render/irradiance_map.h"
#include "engine/render/lobe_frames.h"
#include "engine/render/lobe_planes.h"
#include "engine/view/pack.h"
#include "engine/view/quantize.h"

namespace cei3d {
namespace {

constexpr int kIrradianceSide = 65, kReflectionSide = 128;
constexpr GeometricLadder kReflectionRoughnesses{kMinRoughness, 1.2f};

std::vector<uint32_t> irradiance_nodes(const Device& device, const LobePlanes& lobes) {
  const IrradianceMap map(device, lobes);
  std::vector<uint32_t> out;
  for (int i = 0; i < kIrradianceSide * kIrradianceSide; ++i)
    out.push_back(shared_exponent(map.at(octahedral_node(i, kIrradianceSide))));
  return out;
}

// The rows [begin, end) of a map of the light averaged over round reflection lobes.
void reflect_rows(const Device& device, const LobePlanes& lobes, float roughness, int begin, int end,
                  uint32_t* out) {
  const int count = (end - begin) * kReflectionSide, stride = padded_to_panels(count);
  LobeFrames frames(stride);
  for (int i = 0; i < count; ++i)
    frames.put(size_t(i),
               {octahedral_node(begin * kReflectionSide + i, kReflectionSide), {0, 0, 0}, roughness, 1});
  std::vector<float> radiance(3 * size_t(stride));
  device.launch<SgReflection>({lobes, stride, frames.planes(), radiance.data()}, stride);
  for (int i = 0; i < count; ++i)
    out[begin * kReflectionSide + i] = shared_exponent(load_planes<float>(radiance.data(), stride, i));
}

std::vector<uint32_t> reflection_nodes(const Device& device, const LobePlanes& lobes) {
  constexpr int kNodes = kReflectionSide * kReflectionSide, kRows = 16;
  std::vector<uint32_t> out(size_t(kReflectionLevels) * kNodes);
  for (int level = 0; level < kReflectionLevels; ++level)
    parallel_ranges(kReflectionSide, kRows, [&](int begin, int end) {
      reflect_rows(device, lobes, reflection_level_roughness(level), begin, end,
                   out.data() + size_t(level) * kNodes);
    });
  return out;
}

constexpr int kColumns = 64, kRows = 32;  // size of the tables

// Mean over a reflection lobe of the Legendre polynomial of degree 1 (its mean direction) or 2.
float lobe_band(float roughness, int degree) {
  const ReflectionLobe<double> lobe = reflection_lobe(double(roughness));
  double sum = 0;
  for (int j = 0; j < kReflectionLobes; ++j) {
    const double first = 1 / std::tanh(lobe.lambda[j]) - 1 / lobe.lambda[j];
    sum += reflection_share(j) * (degree == 1 ? first : 1 - 3 * first / lobe.lambda[j]);
  }
  return float(sum);
}

struct Tables {
  std::vector<float> surface, base, fresnel, lobe;
};

void add_lobes(const PartTables& tables, float nv, float roughness, std::vector<float>& out) {
  const float share = table_pair_grad(tables.axis, nv, roughness).value.first;
  const TablePair<float> stretched = table_pair_grad(tables.stretch, nv, roughness).value;
  const LobeRow three = lobe_triple(roughness * stretched.first, max(stretched.second, 1.0f));
  const float steepness =
      kLogisticScale * std::sqrt(horizon_sharpness(stretched_lobe(three.roughness, 1.0f)));
  out.insert(out.end(), {share, reflection_level(three.roughness), three.angle, steepness});
}

Tables make_tables() {
  const ReflectionTables tables = reflection_tables();
  Tables out;
  for (int row = 0; row < kRows; ++row) {
    const float roughness = roughness_of_share(float(row) / (kRows - 1));
    out.lobe.insert(out.lobe.end(), {lobe_band(roughness, 1), lobe_band(roughness, 2), 0, 0});
    for (int column = 0; column < kColumns; ++column) {
      const float root = float(column) / (kColumns - 1), nv = root * root;
      const SplitSum<float> split = split_sum(tables.split_sum, nv, roughness);
      out.surface.insert(out.surface.end(), {split.scale, split.bias, diffuse_view(nv, roughness), 0});
      add_lobes(tables.base, nv, roughness, out.base);
      add_lobes(tables.fresnel, nv, roughness, out.fresnel);
    }
  }
  return out;
}

}  // namespace

float reflection_level_roughness(int level) {
  return kReflectionRoughnesses.at(float(level) / (kReflectionLevels - 1));
}

float reflection_level(float roughness) { return kReflectionRoughnesses.place(roughness); }

std::string view_light(const Device& device, const SgMixture& light) {
  const std::vector<float> planes = lobe_planes(light);
  const int count = int(light.lobes.size());
  const LobePlanes lobes{planes.data(), count, padded_to_panels(count)};
  Pack pack("light");
  pack["irradiance_side"] = kIrradianceSide;
  pack["reflection_side"] = kReflectionSide;
  pack["reflection_levels"] = kReflectionLevels;
  pack.add("irradiance", irradiance_nodes(device, lobes), 1);
  pack.add("reflection", reflection_nodes(device, lobes), 1);
  return pack.bytes();
}

std::string view_sun(float sharpness) {
  constexpr int kNodes = 512;
  const float unit = 1 / sg_integral(sharpness);
  const auto share = [](int node) { return float(node) / (kNodes - 1); };
  std::vector<float> irradiance, reflection;
  for (int i = 0; i < kNodes; ++i) irradiance.push_back(unit * sg_irradiance(sharpness, 2 * share(i) - 1));
  for (int level = 0; level < kReflectionLevels; ++level) {
    const StretchedLobe<float> lobe = stretched_lobe(reflection_level_roughness(level), 1.0f);
    for (int i = 0; i < kNodes; ++i) {
      const float distance = 2 * share(i) * share(i);
      reflection.push_back(unit * sg_reflected(sharpness, lobe, distance * distance, 0.0f));
    }
  }
  Pack pack("sun");
  pack["nodes"] = kNodes;
  pack.add("irradiance", irradiance, 1);
  pack.add("reflection", reflection, 1);
  return pack.bytes();
}

std::string view_tables() {
  const Tables tables = make_tables();
  Pack pack("tables");
  pack["columns"] = kColumns;
  pack["rows"] = kRows;
  pack["min_roughness"] = kMinRoughness;
  pack["middle_share"] = kMiddleShare;
  pack["dielectric_f0"] = kDielectricF0;
  pack["metal_f0"] = kMetalF0;
  pack.add("surface", tables.surface, 4);
  pack.add("base", tables.base, 4);
  pack.add("fresnel", tables.fresnel, 4);
  pack.add("lobe", tables.lobe, 4);
  return pack.bytes();
}

}  // namespace cei3d

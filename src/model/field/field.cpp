// SPDX-License-Identifier: Apache-2.0
#include "model/field/field.h"

#include <algorithm>
#include <cmath>

#include "core/base/aligned.h"
#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "core/base/parallel.h"
#include "core/compute/kernels/panel.h"
#include "core/math/rng.h"
#include "model/field/field_pass.h"

namespace cei3d {

int encoding_rows(const EncodingConfig& e) { return 3 + 6 * e.frequencies + 2 * e.levels; }

MlpConfig mlp_config(const FieldConfig& c) {
  return {encoding_rows(c.encoding),
          c.hidden_layers,
          c.width,
          c.skip_layer,
          c.activation,
          c.softplus_beta,
          c.outputs,
          c.output_activation};
}

GridLevel grid_level(const EncodingConfig& e, int level) {
  const double growth =
      e.levels > 1 ? std::pow(double(e.finest_resolution) / e.base_resolution, 1.0 / (e.levels - 1)) : 1;
  const double resolution = std::floor(e.base_resolution * std::pow(growth, level) + 1e-6);
  const double corners = std::pow(resolution + 1, 3);
  const uint32_t table = 1u << e.log2_table;
  return {float(resolution), uint32_t(resolution) + 1, corners <= table ? 0u : table - 1};
}

namespace {

int64_t level_entries(const EncodingConfig& e, int level) {
  const GridLevel g = grid_level(e, level);
  return g.hash_mask ? int64_t(g.hash_mask) + 1 : int64_t(g.dense_stride) * g.dense_stride * g.dense_stride;
}

void check_config(const FieldConfig& c) {
  const EncodingConfig& e = c.encoding;
  const auto in_range = [](int v, int lo, int hi, const char* name) {
    if (v < lo || v > hi) fail("'{}' of a field is {}, but must be {} to {}.", name, v, lo, hi);
  };
  in_range(e.frequencies, 0, 16, "frequencies");
  in_range(e.levels, 0, 24, "levels");
  in_range(e.base_resolution, 1, 4096, "base_resolution");
  in_range(e.finest_resolution, e.base_resolution, 65536, "finest_resolution");
  in_range(e.log2_table, 4, 24, "log2_table");
  in_range(c.hidden_layers, 0, 32, "hidden_layers");
  in_range(c.width, 1, 4096, "width");
  in_range(c.outputs, 1, 1024, "outputs");
  if (c.skip_layer >= 0) in_range(c.width, encoding_rows(e) + 1, 4096, "width");
}

}  // namespace

Field::Field(const FieldConfig& config, uint64_t seed) : config_(config) {
  check_config(config);
  const EncodingConfig& e = config.encoding;
  for (int l = 0; l < e.levels; ++l) {
    Param& table = params_.add("encoding/level" + std::to_string(l), {level_entries(e, l), 2});
    for (size_t i = 0; i < table.count(); ++i)
      table.value[i] = 1e-4f * (2 * Rng(seed, 1000 + l, i).uniform() - 1);
  }
  add_mlp_params(mlp_config(config), params_, seed);
}

void Field::eval(const Device& device, std::span<const Vec3f> x, std::span<float> out) const {
  constexpr int kGrain = 4096, kBlock = 512;
  if (x.empty()) return;
  const MlpWeights weights(mlp_config(config_), params_);
  const int outputs = int(out.size() / x.size());
  if (outputs < 1 || outputs > config_.outputs || out.size() % x.size() != 0)
    fail("A field of {} outputs at {} points has no room for {} values (an error in the program).",
         config_.outputs, x.size(), out.size());
  parallel_ranges(int(x.size()), kGrain, [&](int begin, int end) {
    FieldPass pass(config_, kBlock, 1);
    AlignedVector<float> points(size_t(kBlock) * 3);
    for (int b = begin; b < end; b += kBlock) {
      const int n = std::min(kBlock, end - b), padded = padded_to_panels(n);
      points_to_panels(&x[b], n, points.data());
      pass.forward(device, *this, weights, points.data(), padded, config_.encoding.levels, outputs);
      for (int i = 0; i < n; ++i)
        for (int o = 0; o < outputs; ++o)
          out[size_t(b + i) * outputs + o] = pass.output()[panel_at(i, 1, 0, config_.outputs, o)];
    }
  });
}

std::vector<Vec3f> Field::eval3(const Device& device, std::span<const Vec3f> x) const {
  std::vector<float> values(3 * x.size());
  eval(device, x, values);
  std::vector<Vec3f> out(x.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return out;
}

namespace {

const std::pair<Activation, const char*> kActivations[] = {{Activation::none, "none"},
                                                           {Activation::relu, "relu"},
                                                           {Activation::elu, "elu"},
                                                           {Activation::softplus, "softplus"},
                                                           {Activation::sigmoid, "sigmoid"}};

std::string activation_name(Activation a) {
  for (const auto& [value, name] : kActivations)
    if (value == a) return name;
  return "none";
}

Activation activation_from(const std::string& name) {
  for (const auto& [value, known] : kActivations)
    if (name == known) return value;
  fail("A field has the activation '{}', which this program does not know. Update cei3d.", name);
}

// Visits every member under its JSON name; writing and reading share this list.
template <class C, class V>
void describe(C& c, V visit) {
  visit("frequencies", c.encoding.frequencies);
  visit("levels", c.encoding.levels);
  visit("base_resolution", c.encoding.base_resolution);
  visit("finest_resolution", c.encoding.finest_resolution);
  visit("log2_table", c.encoding.log2_table);
  visit("hidden_layers", c.hidden_layers);
  visit("width", c.width);
  visit("skip_layer", c.skip_layer);
  visit("activation", c.activation);
  visit("softplus_beta", c.softplus_beta);
  visit("outputs", c.outputs);
  visit("output_activation", c.output_activation);
  visit("sphere_radius", c.sphere_radius);
}

}  // namespace

Json to_json(const FieldConfig& config) {
  Json j;
  describe(config, [&](const char* name, const auto& v) {
    if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Activation>)
      j[name] = activation_name(v);
    else
      j[name] = v;
  });
  return j;
}

FieldConfig field_config_from_json(const Json& j, const std::string& what) {
  FieldConfig config;
  JsonReader reader(j, what);
  describe(config, [&](const char* name, auto& v) {
    if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Activation>) {
      if (reader.has(name)) v = activation_from(reader.require<std::string>(name));
    } else {
      v = reader.optional(name, v);
    }
  });
  reader.finish();
  check_config(config);
  return config;
}

std::vector<float> first_output(const Device& device, const Field& field, std::span<const Vec3f> x) {
  std::vector<float> first(x.size());
  field.eval(device, x, first);
  return first;
}

}  // namespace cei3d

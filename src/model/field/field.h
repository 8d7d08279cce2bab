// SPDX-License-Identifier: Apache-2.0
// A field: an encoding of a point and a small network behind it. SDF, albedo and every edit branch are
// fields; what tells the presets apart is data (FieldConfig), not code.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "core/compute/device.h"
#include "core/math/vec.h"
#include "model/field/mlp.h"
#include "model/field/params.h"

namespace cei3d {

struct EncodingConfig {
  int frequencies = 0;          // L of the frequency encoding, sin and cos of 2^k x, k < L; 0: none
  int levels = 0;               // of the hash grid; 0: none
  int base_resolution = 16;     // cells along [-1, 1] at level 0
  int finest_resolution = 256;  // ... and at the last level; geometric in between
  int log2_table = 15;          // entries a level, 2 features each
};

struct FieldConfig {
  EncodingConfig encoding;  // the raw point (3 rows) always comes first
  int hidden_layers = 1;
  int width = 64;
  int skip_layer = -1;  // the encoding enters again before this hidden layer, divided by sqrt 2; -1: never
  Activation activation = Activation::relu;
  float softplus_beta = 100;
  int outputs = 3;
  Activation output_activation = Activation::none;
  // > 0: |x| - sphere_radius is added to output 0, so that an untrained SDF is a sphere
  float sphere_radius = 0;
};
Json to_json(const FieldConfig&);
FieldConfig field_config_from_json(const Json&);  // error on unknown keys

int encoding_rows(const EncodingConfig&);
MlpConfig mlp_config(const FieldConfig&);
GridLevel grid_level(const EncodingConfig&, int level);

class Field {
 public:
  Field(const FieldConfig& config, uint64_t seed);

  const FieldConfig& config() const { return config_; }
  ParamSet& params() { return params_; }  // by name: "encoding/level3", "layer0/weight", "layer0/bias"
  const ParamSet& params() const { return params_; }
  const float* table(int level) const { return params_.all()[level].value.data(); }  // tables come first

  // Values at points in [-1, 1]^3. x: #N, out: #N x the first so many outputs as there is room for,
  // row-major. Runs on all threads.
  void eval(const Device& device, std::span<const Vec3f> x, std::span<float> out) const;

 private:
  FieldConfig config_;
  ParamSet params_;
};

// Output 0 of the field at points x: the distance, of an SDF. #N.
std::vector<float> first_output(const Device&, const Field&, std::span<const Vec3f> x);

// Fits a field to a loss on its values, by Adam.
class FieldTrainer {
 public:
  struct Options {
    float encoding_rate = 1e-2f;  // Adam rate of the hash tables (entries without gradient are skipped)
    float network_rate = 2e-3f;   // ... and of the layers
  };
  FieldTrainer(Field& field, const Options& options);
  ~FieldTrainer();

  // loss(begin, end, out, d_out): reads the outputs of points [begin, end), row-major from out[0], and writes
  // dL/d(output) to d_out; called from several threads, on ranges that don't depend on their number and begin
  // at multiples of 32.
  using Loss = std::function<void(int begin, int end, const float* out, float* d_out)>;
  // One Adam step. x: #N. `rate` scales both learning rates (schedules); `levels`: hash levels in use, -1:
  // all.
  void step(const Device& device, std::span<const Vec3f> x, const Loss& loss, float rate = 1,
            int levels = -1);

 private:
  struct State;
  Field& field_;
  Options options_;
  std::unique_ptr<State> state_;
};

}  // namespace cei3d

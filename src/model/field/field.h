// SPDX-License-Identifier: Apache-2.0
// A field: an encoding of a point followed by a small network. The SDF, the albedo and the color branch of
// every edit are fields; presets differ in data (FieldConfig), not in code.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/compute/device.h"
#include "core/math/encoding.h"
#include "core/math/vec.h"
#include "model/field/adam_constants.h"
#include "model/field/mlp.h"
#include "model/field/params.h"

namespace cei3d {

struct EncodingConfig {
  int frequencies = 0;          // frequency encoding: sin and cos of 2^k x for k < frequencies; 0: none
  int levels = 0;               // levels of the hash grid; 0: none
  int base_resolution = 16;     // cells along [-1, 1] at level 0
  int finest_resolution = 256;  // cells along [-1, 1] at the last level; geometric in between
  int log2_table = 15;          // entries per level, 2 features each
};

struct FieldConfig {
  EncodingConfig encoding;  // the raw point (3 rows) comes first, always
  int hidden_layers = 1;
  int width = 64;
  // Hidden layer before which the encoding is appended again, divided by sqrt 2; -1: none
  int skip_layer = -1;
  Activation activation = Activation::relu;
  float softplus_beta = 100;
  int outputs = 3;
  Activation output_activation = Activation::none;
  // If > 0, |x| - sphere_radius is added to output 0, so that an untrained SDF is a sphere.
  float sphere_radius = 0;
};
Json to_json(const FieldConfig&);
// Error: unknown keys.
FieldConfig field_config_from_json(const Json&, const std::string& what = "The configuration of a network");

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

  // Values at points in [-1, 1]^3. x: #N. out: #N rows of the first outputs, as many as fit. Uses all
  // threads.
  void eval(const Device& device, std::span<const Vec3f> x, std::span<float> out) const;
  // A field of three outputs at every point.
  std::vector<Vec3f> eval3(const Device& device, std::span<const Vec3f> x) const;

 private:
  FieldConfig config_;
  ParamSet params_;
};

// Output 0 of the field at points x (for an SDF, the distance): #N.
std::vector<float> first_output(const Device&, const Field&, std::span<const Vec3f> x);

// Output 0 of a field at a point, and its derivatives by the point.
struct FieldJet {
  float value;
  Vec3f gradient;
};

// Factor of the rates of a descent that ends in small steps: from 1 to a thousandth, along a half wave.
// fraction: of the descent, [0, 1].
inline float cosine_decay(float fraction) { return 0.5f * (1 + std::cos(kPi * fraction)) + 1e-3f; }

// Fits a field to a loss on its values, by Adam.
class FieldTrainer {
 public:
  struct Options {
    float encoding_rate = 1e-2f;  // Adam's rate for hash tables (entries without gradient are skipped)
    float network_rate = 2e-3f;   // Adam's rate for layers
    AdamConstants adam{};
  };
  FieldTrainer(Field& field, const Options& options);
  ~FieldTrainer();

  // loss(begin, end, out, d_out): reads the outputs of points [begin, end), row-major from out[0], and writes
  // dL/d(output) to d_out. Called from several threads, on ranges that do not depend on the number of threads
  // and begin at multiples of 32.
  using Loss = std::function<void(int begin, int end, const float* out, float* d_out)>;
  // One Adam step. x: #N. rate: scales both learning rates. levels: hash levels in use, -1: all.
  void step(const Device& device, std::span<const Vec3f> x, const Loss& loss, float rate = 1,
            int levels = -1);

  // A step by the sum of several losses: accumulate() and accumulate_jets() add up gradients, update() makes
  // the step.
  void accumulate(const Device& device, std::span<const Vec3f> x, const Loss& loss, int levels = -1);
  // The derivative of a loss by the value and the spatial gradient of output 0 at point i.
  using JetLoss = std::function<FieldJet(int i, const FieldJet&)>;
  void accumulate_jets(const Device& device, std::span<const Vec3f> x, const JetLoss& loss, int levels = -1);
  void update(const Device& device, float rate = 1);
  std::span<const float> gradient(const Param& param) const;  // accumulated since the last update

  // Adam's moments; the field is not in them.
  void save(Tensors& out, const std::string& prefix) const;
  void load(const Tensors& in, const std::string& prefix);

 private:
  struct State;
  template <class Chunk>
  void for_chunks(const Device&, std::span<const Vec3f> x, int columns, int levels, const Chunk&);
  Field& field_;
  Options options_;
  std::unique_ptr<State> state_;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Pre-trained networks in ONNX format, run by ONNX Runtime. The library is opened at run time when it is
// first needed, so the program builds and runs without it; the error then says what to install.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace cei3d {

// Row-major floats.
struct OnnxTensor {
  std::vector<int64_t> shape;
  std::vector<float> data;  // product of the shape
};
using OnnxTensors = std::map<std::string, OnnxTensor>;  // by name

class OnnxRuntime {
 public:
  // folder: searched first for libonnxruntime.so.1, then the system's library folders. Error: not found, or
  // older than 1.11.
  explicit OnnxRuntime(const std::filesystem::path& folder);
  ~OnnxRuntime();
  OnnxRuntime(const OnnxRuntime&) = delete;
  OnnxRuntime& operator=(const OnnxRuntime&) = delete;

  // Whether the library can be loaded.
  static bool available(const std::filesystem::path& folder);
  const std::string& version() const { return version_; }

 private:
  friend class OnnxModel;
  struct State;
  std::string version_;
  std::unique_ptr<State> state_;
};

class OnnxModel {
 public:
  // threads: used by a run; 0: all cores. Results do not depend on it. Error: the file is missing or not a
  // network.
  OnnxModel(std::shared_ptr<const OnnxRuntime>, const std::filesystem::path& file, int threads = 0);
  ~OnnxModel();
  OnnxModel(const OnnxModel&) = delete;
  OnnxModel& operator=(const OnnxModel&) = delete;

  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& outputs() const { return outputs_; }
  bool has_input(const std::string& name) const;

  // inputs: one for each name in inputs(). wanted: names of outputs. Errors: a missing input, a shape that
  // does not fit its data or the network, an output that does not exist or does not hold floats.
  OnnxTensors run(const OnnxTensors& inputs, const std::vector<std::string>& wanted) const;

 private:
  struct State;
  std::shared_ptr<const OnnxRuntime> runtime_;
  std::filesystem::path file_;
  std::vector<std::string> inputs_, outputs_;
  std::unique_ptr<State> state_;
};

}  // namespace cei3d

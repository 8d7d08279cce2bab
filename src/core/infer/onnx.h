// SPDX-License-Identifier: Apache-2.0
// Neural networks that others have trained: files in ONNX format, run by ONNX Runtime. The library is opened
// when it is first needed; the program builds and runs without it, and then says what to install.
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
  // folder: where the library is looked for first, as libonnxruntime.so.1; then where the system keeps
  // libraries. Error: it is nowhere, or older than 1.11.
  explicit OnnxRuntime(const std::filesystem::path& folder);
  ~OnnxRuntime();
  OnnxRuntime(const OnnxRuntime&) = delete;
  OnnxRuntime& operator=(const OnnxRuntime&) = delete;

  // Whether the library is there.
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
  // threads: of one run; 0: as many as there are cores. Results do not depend on it. Error: a file that is
  // missing or no network.
  OnnxModel(std::shared_ptr<const OnnxRuntime>, const std::filesystem::path& file, int threads = 0);
  ~OnnxModel();
  OnnxModel(const OnnxModel&) = delete;
  OnnxModel& operator=(const OnnxModel&) = delete;

  const std::vector<std::string>& inputs() const { return inputs_; }
  const std::vector<std::string>& outputs() const { return outputs_; }
  bool has_input(const std::string& name) const;

  // inputs: one for each name of inputs(). wanted: names of outputs. Errors: a missing input, a shape that
  // does not fit its data or the network, an output that is not there or not of floats.
  OnnxTensors run(const OnnxTensors& inputs, const std::vector<std::string>& wanted) const;

 private:
  struct State;
  std::shared_ptr<const OnnxRuntime> runtime_;
  std::filesystem::path file_;
  std::vector<std::string> inputs_, outputs_;
  std::unique_ptr<State> state_;
};

}  // namespace cei3d

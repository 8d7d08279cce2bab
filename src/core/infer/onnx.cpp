// SPDX-License-Identifier: Apache-2.0
#include "core/infer/onnx.h"

#include <dlfcn.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/infer/ort_abi.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;

// Owns an object of the library; released by the library's function.
template <class T, class Release>
class Owned {
 public:
  explicit Owned(const void* const* api) : api_(api) {}
  ~Owned() {
    if (p_) reinterpret_cast<typename Release::Function>(const_cast<void*>(api_[Release::position]))(p_);
  }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  T* get() const { return p_; }
  T** out() { return &p_; }

 private:
  const void* const* api_;
  T* p_ = nullptr;
};

// The library's table of functions. A failed call throws the library's message.
class Api {
 public:
  explicit Api(const void* const* table) : table_(table) {}
  const void* const* table() const { return table_; }

  template <class E, class... A>
  void call(const std::string& what, A... arguments) const {
    ort::Status* status = function<E>()(arguments...);
    if (!status) return;
    const std::string message = function<ort::GetErrorMessage>()(status);
    function<ort::ReleaseStatus>()(status);
    fail("{}: ONNX Runtime says: {}", what, message);
  }

 private:
  template <class E>
  typename E::Function function() const {
    return reinterpret_cast<typename E::Function>(const_cast<void*>(table_[E::position]));
  }
  const void* const* table_;
};

// Opens the library under the names that releases and distributions use. It stays open until the process
// ends, because it has threads of its own.
void* open_library(const fs::path& folder) {
  const std::string own = (folder / "libonnxruntime.so.1").string();
  for (const std::string& name : {own, std::string("libonnxruntime.so.1"),
                                  std::string("libonnxruntime.so.1.21"), std::string("libonnxruntime.so")})
    if (void* library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
  return nullptr;
}

// The library's table of functions, and its version.
const void* const* open_api(const fs::path& folder, std::string& version) {
  void* library = open_library(folder);
  if (!library)
    fail(
        "ONNX Runtime, which runs networks of others, is not installed (looked for {} and the system's own). "
        "`./run sam` installs it.",
        (folder / "libonnxruntime.so.1").string());
  using GetBase = const ort::ApiBase* (*)();
  const auto get_base = reinterpret_cast<GetBase>(dlsym(library, "OrtGetApiBase"));
  if (!get_base) fail("The libonnxruntime found is no ONNX Runtime; `./run sam` installs one.");
  version = get_base()->version();
  const void* const* table = get_base()->get_api(ort::kApiVersion);
  if (!table) fail("ONNX Runtime {} is too old; `./run sam` installs a newer one.", version);
  return table;
}

template <class Count, class Name>
std::vector<std::string> names(const Api& api, const ort::Session* session, const std::string& what) {
  ort::Allocator* allocator = nullptr;
  api.call<ort::GetAllocatorWithDefaultOptions>(what, &allocator);
  size_t count = 0;
  api.call<Count>(what, session, &count);
  std::vector<std::string> result;
  for (size_t i = 0; i < count; ++i) {
    char* name = nullptr;
    api.call<Name>(what, session, i, allocator, &name);
    result.emplace_back(name);
    api.call<ort::AllocatorFree>(what, allocator, static_cast<void*>(name));
  }
  return result;
}

size_t elements(const std::vector<int64_t>& shape) {
  size_t n = 1;
  for (int64_t d : shape) n *= size_t(d);
  return n;
}

OnnxTensor copy_out(const Api& api, ort::Value* value, const std::string& what) {
  Owned<ort::ShapeInfo, ort::ReleaseShapeInfo> info(api.table());
  api.call<ort::GetTensorTypeAndShape>(what, value, info.out());
  int type = 0;
  api.call<ort::GetTensorElementType>(what, info.get(), &type);
  if (type != ort::kFloatElements) fail("{}: an output does not consist of 32-bit floats.", what);
  size_t dimensions = 0;
  api.call<ort::GetDimensionsCount>(what, info.get(), &dimensions);
  OnnxTensor t;
  t.shape.resize(dimensions);
  api.call<ort::GetDimensions>(what, info.get(), t.shape.data(), dimensions);
  void* data = nullptr;
  api.call<ort::GetTensorMutableData>(what, value, &data);
  const auto* floats = static_cast<const float*>(data);
  t.data.assign(floats, floats + elements(t.shape));
  return t;
}

}  // namespace

struct OnnxRuntime::State {
  explicit State(const void* const* table) : api(table), env(table), memory(table) {}
  Api api;
  Owned<ort::Env, ort::ReleaseEnv> env;
  Owned<ort::MemoryInfo, ort::ReleaseMemoryInfo> memory;
};

OnnxRuntime::OnnxRuntime(const fs::path& folder) {
  state_ = std::make_unique<State>(open_api(folder, version_));
  state_->api.call<ort::CreateEnv>("Starting", ort::kLogErrors, "cei3d", state_->env.out());
  state_->api.call<ort::CreateCpuMemoryInfo>("Starting", ort::kArenaAllocator, ort::kDefaultMemory,
                                             state_->memory.out());
}

OnnxRuntime::~OnnxRuntime() = default;

bool OnnxRuntime::available(const fs::path& folder) { return open_library(folder) != nullptr; }

struct OnnxModel::State {
  explicit State(const void* const* table) : session(table) {}
  Owned<ort::Session, ort::ReleaseSession> session;
};

OnnxModel::OnnxModel(std::shared_ptr<const OnnxRuntime> runtime, const fs::path& file, int threads)
    : runtime_(std::move(runtime)), file_(file) {
  const std::string bytes = read_file(file), what = file.string();
  const Api& api = runtime_->state_->api;
  Owned<ort::SessionOptions, ort::ReleaseSessionOptions> options(api.table());
  api.call<ort::CreateSessionOptions>(what, options.out());
  api.call<ort::SetIntraOpNumThreads>(what, options.get(), threads);
  // No spinning: idle threads would compete with the program's own. No memory patterns: they cost memory and
  // save no time here.
  api.call<ort::AddSessionConfigEntry>(what, options.get(), "session.intra_op.allow_spinning", "0");
  api.call<ort::DisableMemPattern>(what, options.get());
  state_ = std::make_unique<State>(api.table());
  api.call<ort::CreateSessionFromArray>(what, runtime_->state_->env.get(), bytes.data(), bytes.size(),
                                        options.get(), state_->session.out());
  inputs_ = names<ort::SessionGetInputCount, ort::SessionGetInputName>(api, state_->session.get(), what);
  outputs_ = names<ort::SessionGetOutputCount, ort::SessionGetOutputName>(api, state_->session.get(), what);
}

OnnxModel::~OnnxModel() = default;

bool OnnxModel::has_input(const std::string& name) const {
  return std::find(inputs_.begin(), inputs_.end(), name) != inputs_.end();
}

OnnxTensors OnnxModel::run(const OnnxTensors& inputs, const std::vector<std::string>& wanted) const {
  const Api& api = runtime_->state_->api;
  const std::string what = file_.string();
  std::vector<std::unique_ptr<Owned<ort::Value, ort::ReleaseValue>>> owned;
  std::vector<const ort::Value*> in;
  std::vector<const char*> in_names, out_names;
  for (const std::string& name : inputs_) {
    const auto it = inputs.find(name);
    if (it == inputs.end())
      fail("{}: the network wants an input named {}, which is not known here.", what, name);
    const OnnxTensor& t = it->second;
    if (t.data.size() != elements(t.shape))
      fail("{}: input {} has a shape that its data do not fill.", what, name);
    owned.push_back(std::make_unique<Owned<ort::Value, ort::ReleaseValue>>(api.table()));
    // The library takes non-const pointers but does not write to inputs.
    api.call<ort::CreateTensorWithData>(what, runtime_->state_->memory.get(),
                                        static_cast<void*>(const_cast<float*>(t.data.data())),
                                        t.data.size() * sizeof(float), t.shape.data(), t.shape.size(),
                                        ort::kFloatElements, owned.back()->out());
    in.push_back(owned.back()->get());
    in_names.push_back(name.c_str());
  }
  for (const std::string& name : wanted) {
    if (std::find(outputs_.begin(), outputs_.end(), name) == outputs_.end())
      fail("{}: the network has no output named {}.", what, name);
    out_names.push_back(name.c_str());
  }
  std::vector<ort::Value*> out(wanted.size(), nullptr);
  api.call<ort::Run>(what, state_->session.get(), nullptr, in_names.data(), in.data(), in.size(),
                     out_names.data(), out_names.size(), out.data());
  std::vector<std::unique_ptr<Owned<ort::Value, ort::ReleaseValue>>> results;
  for (ort::Value* value : out) {
    results.push_back(std::make_unique<Owned<ort::Value, ort::ReleaseValue>>(api.table()));
    *results.back()->out() = value;
  }
  OnnxTensors tensors;
  for (size_t i = 0; i < wanted.size(); ++i) tensors[wanted[i]] = copy_out(api, results[i]->get(), what);
  return tensors;
}

}  // namespace cei3d

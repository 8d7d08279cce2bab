// SPDX-License-Identifier: Apache-2.0
// The part of ONNX Runtime's C interface that is used here. The library is opened at run time, so neither it
// nor its headers are needed to build.
//
// The interface is one table of function pointers. The library promises to keep its order ("the ordering of
// the fields must not change", onnxruntime_c_api.h) and only appends. The positions below hold for every
// release from 1.11 on; they were compared with offsetof() on the headers of 1.21.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cei3d::ort {

inline constexpr uint32_t kApiVersion = 11;
inline constexpr int kLogErrors = 3;       // ORT_LOGGING_LEVEL_ERROR
inline constexpr int kArenaAllocator = 1;  // OrtArenaAllocator
inline constexpr int kDefaultMemory = 0;   // OrtMemTypeDefault
inline constexpr int kFloatElements = 1;   // ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT

// Opaque objects of the library.
struct Status;
struct Env;
struct Session;
struct SessionOptions;
struct RunOptions;
struct Value;
struct MemoryInfo;
struct ShapeInfo;
struct Allocator;

struct ApiBase {
  const void* const* (*get_api)(uint32_t version);  // null: the library is too old
  const char* (*version)();
};

// A function of the table, by position and type.
template <size_t N, class F>
struct Entry {
  using Function = F*;
  static constexpr size_t position = N;
};

using GetErrorMessage = Entry<2, const char*(const Status*)>;
using CreateEnv = Entry<3, Status*(int log_level, const char* name, Env**)>;
using CreateSessionFromArray =
    Entry<8, Status*(const Env*, const void* bytes, size_t size, const SessionOptions*, Session**)>;
using Run = Entry<9, Status*(Session*, const RunOptions*, const char* const* input_names,
                             const Value* const* inputs, size_t input_count, const char* const* output_names,
                             size_t output_count, Value** outputs)>;
using CreateSessionOptions = Entry<10, Status*(SessionOptions**)>;
using DisableMemPattern = Entry<17, Status*(SessionOptions*)>;
using SetIntraOpNumThreads = Entry<24, Status*(SessionOptions*, int)>;
using SessionGetInputCount = Entry<30, Status*(const Session*, size_t*)>;
using SessionGetOutputCount = Entry<31, Status*(const Session*, size_t*)>;
using SessionGetInputName = Entry<36, Status*(const Session*, size_t, Allocator*, char**)>;
using SessionGetOutputName = Entry<37, Status*(const Session*, size_t, Allocator*, char**)>;
using CreateTensorWithData =
    Entry<49, Status*(const MemoryInfo*, void* data, size_t bytes, const int64_t* shape, size_t dimensions,
                      int element_type, Value**)>;
using GetTensorMutableData = Entry<51, Status*(Value*, void**)>;
using GetTensorElementType = Entry<60, Status*(const ShapeInfo*, int*)>;
using GetDimensionsCount = Entry<61, Status*(const ShapeInfo*, size_t*)>;
using GetDimensions = Entry<62, Status*(const ShapeInfo*, int64_t*, size_t)>;
using GetTensorTypeAndShape = Entry<65, Status*(const Value*, ShapeInfo**)>;
using CreateCpuMemoryInfo = Entry<69, Status*(int allocator, int memory, MemoryInfo**)>;
using AllocatorFree = Entry<76, Status*(Allocator*, void*)>;
using GetAllocatorWithDefaultOptions = Entry<78, Status*(Allocator**)>;
using ReleaseEnv = Entry<92, void(Env*)>;
using ReleaseStatus = Entry<93, void(Status*)>;
using ReleaseMemoryInfo = Entry<94, void(MemoryInfo*)>;
using ReleaseSession = Entry<95, void(Session*)>;
using ReleaseValue = Entry<96, void(Value*)>;
using ReleaseShapeInfo = Entry<99, void(ShapeInfo*)>;
using ReleaseSessionOptions = Entry<100, void(SessionOptions*)>;
using AddSessionConfigEntry = Entry<130, Status*(SessionOptions*, const char* key, const char* value)>;

}  // namespace cei3d::ort

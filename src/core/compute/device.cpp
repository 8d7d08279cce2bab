// SPDX-License-Identifier: Apache-2.0
#include "core/compute/device.h"

#include "core/base/error.h"
#ifdef CEI3D_CUDA_DEVICE
#include "core/compute/cuda/device.h"
#endif

namespace cei3d {

namespace scalar {
extern const LaunchTable table;
}
#ifdef CEI3D_AVX2
namespace avx2 {
extern const LaunchTable table;
}
#endif
#ifdef CEI3D_AVX512
namespace avx512 {
extern const LaunchTable table;
}
#endif

namespace {

std::vector<Device> cpu_devices() {
  std::vector<Device> devices{Device(scalar::table)};
#ifdef CEI3D_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) devices.emplace_back(avx2::table);
#endif
#ifdef CEI3D_AVX512
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    devices.emplace_back(avx512::table);
#endif
  return devices;
}

}  // namespace

std::vector<Device> all_devices() {
  std::vector<Device> devices = cpu_devices();
#ifdef CEI3D_CUDA_DEVICE
  if (cuda::reason_for_no_card().empty()) devices.emplace_back(cuda::table);
#endif
  return devices;
}

Device make_device(std::string_view spec) {
  if (spec == "auto" || spec == "cpu") return cpu_devices().back();
  const std::vector<Device> devices = all_devices();
  for (const Device& d : devices)
    if (d.name() == spec) return d;
  std::string known;
  for (const Device& d : devices) known += (known.empty() ? "" : ", ") + d.name();
  fail_usage("device '{}' is not available here; this machine has: auto, cpu, {}", spec, known);
}

}  // namespace cei3d

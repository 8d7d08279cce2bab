// SPDX-License-Identifier: Apache-2.0
#include "engine/session/light_choice.h"

#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/math/rotation.h"
#include "core/math/sg.h"
#include "engine/io/image_file.h"
#include "engine/io/npy.h"
#include "model/light/fit.h"

namespace cei3d {
namespace {

// "blender" equals "zup": center +X, row 0 +Z. "mitsuba" equals "yup".
EnvUp row_zero(EnvConvention convention, Vec3f up) {
  switch (convention) {
    case EnvConvention::zup:
    case EnvConvention::blender:
      return EnvUp::z;
    case EnvConvention::yup:
    case EnvConvention::mitsuba:
      return EnvUp::y;
    case EnvConvention::by_up_axis:
      break;
  }
  return std::abs(up.y) > 0.9f ? EnvUp::y : EnvUp::z;
}

void require_lat_long(const Image& map, const std::filesystem::path& path) {
  if (map.width != 2 * map.height)
    fail("{} is {}x{} pixels; a latitude-longitude image is twice as wide as high.", path.string(), map.width,
         map.height);
  if (map.channels < 3) fail("{} has no colors; save the environment as RGB.", path.string());
  double sum = 0;
  for (const float v : map.data) {
    if (!std::isfinite(v)) fail("{} holds NaN or infinite values; convert it again.", path.string());
    sum += v;
  }
  if (sum <= 0) fail("{} is black: there is no light in it.", path.string());
}

SgMixture light_of_picture(const Device& device, const LightChoice& choice, Vec3f up) {
  const Image map = read_linear_image(choice.env);
  require_lat_long(map, choice.env);
  const EnvUp row = row_zero(choice.convention, up);
  const SgMixture light = fit_lobes(device, map, {}, row);
  if (choice.convention != EnvConvention::by_up_axis) return light;
  return rotated(light, turning(row == EnvUp::y ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1}, up));  // skies are up
}

SgMixture read_lobes(const std::filesystem::path& path) {
  const NpyArray array = read_npy(path);
  if (array.shape.size() != 2 || array.shape[1] != 7)
    fail("{} does not hold lobes, which are rows of 7: axis, sharpness, color.", path.string());
  return light_from_array(array.floats());
}

constexpr int kFit = 2;  // version of fit_lobes(): raise it when the same image gives other lobes

std::filesystem::path cache_file(const LightCache& cache, const LightChoice& choice, Vec3f up) {
  const std::string picture = content_hash(read_file(choice.env));
  const std::string key =
      content_hash(fmt::format("{} {} {} {} {} {}", picture, kFit, int(choice.convention), up.x, up.y, up.z));
  return cache.folder / ("light-" + key + ".npy");
}

// A cached file that cannot be read is recomputed.
std::optional<SgMixture> cached_light(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  try {
    return read_lobes(file);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

SgMixture environment_light(const Device& device, const LightChoice& choice, Vec3d up,
                            const LightCache& cache) {
  if (choice.env.extension() == ".npy") return read_lobes(choice.env);
  const Vec3f axis = to_float(normalize(up));
  if (cache.folder.empty()) return light_of_picture(device, choice, axis);
  const std::filesystem::path file = cache_file(cache, choice, axis);
  if (const auto light = cached_light(file)) return *light;
  const SgMixture light = light_of_picture(device, choice, axis);
  if (cache.writable) write_npy(file, to_array(light), int64_t(light.lobes.size()), 7);
  return light_from_array(to_array(light));  // rounded as the cache stores it
}

SgMixture with_sun(const SgMixture& light, const Sun& sun) {
  Vec3f power{0, 0, 0};
  for (const SgLobe& lobe : light.lobes) power += lobe.mu * sg_integral(lobe.lambda);
  const float received = (power.x + power.y + power.z) / 3 / 4;  // mean over all normals
  const float peak = float(sun.strength) * received / sg_integral(kSunSharpness);
  SgMixture out = light;
  out.lobes.push_back({to_float(normalize(sun.direction)), kSunSharpness, Vec3f{1, 1, 1} * peak});
  return out;
}

void check_choice(const LightChoice& choice) {
  if (!std::isfinite(choice.rotate_degrees)) fail_usage("The angle to turn the light by is not a number.");
  if (!(choice.scale > 0 && choice.scale <= 1e6))
    fail_usage("{} is not a factor for the light; give one above 0, and up to 1e6.", choice.scale);
  if (!choice.sun) return;
  const double far = length(choice.sun->direction);
  if (!(far > 0 && std::isfinite(far)))
    fail_usage("The direction to the sun has no length; give three numbers.");
  if (!(choice.sun->strength >= 0 && choice.sun->strength <= 1e6))
    fail_usage("{} is not a strength of the sun; give one from 0 to 1e6.", choice.sun->strength);
}

SgMixture turned_light(const SgMixture& light, double degrees, double scale, Vec3d up) {
  SgMixture out = light;
  if (degrees != 0) out = rotated(out, about_axis(to_float(normalize(up)), float(degrees) * kPi / 180));
  if (scale != 1) out = scaled(out, Vec3f{1, 1, 1} * float(scale));
  return out;
}

SgMixture chosen_light(const Device& device, const LightChoice& choice, const SgMixture& own, Vec3d up,
                       const LightCache& cache) {
  check_choice(choice);
  const SgMixture light = choice.env.empty() ? own : environment_light(device, choice, up, cache);
  const SgMixture turned = turned_light(light, choice.rotate_degrees, choice.scale, up);
  return choice.sun ? with_sun(turned, *choice.sun) : turned;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// `cei3d synth`: a capture of a body whose shape, light and materials are known, with the truth beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/progress.h"
#include "engine/synthetic/path_tracer.h"

namespace cei3d {

// The finish of one region, instead of that of the set.
struct RegionFinish {
  std::string region;
  Finish finish;
};

enum class SynthLayout {
  nerf,  // NeRF-synthetic: 8-bit sRGB PNG
  physg  // PhySG: linear EXR, with radiance above 1
};

struct SynthRequest {
  std::filesystem::path out;  // missing, or an empty folder
  std::string shape = "teapot", material = "plastic", light = "daylight";
  std::vector<RegionFinish> regions;  // a later one replaces an earlier one
  std::optional<float> roughness;     // of every region
  Vec3f light_tint{1, 1, 1};          // factor of the light's color
  float light_strength = 1;
  bool light_turns = false;  // with the camera about z, as if the body stood on a turntable
  Diffuse diffuse = Diffuse::burley;
  SynthLayout layout = SynthLayout::nerf;
  int bounces = 3;
  int width = 200, height = 200;
  int views = 100, test_views = 20;
  int samples = 32;  // a pixel
  float noise = 0;   // standard deviation, of the training images' sRGB values
  uint64_t seed = 1;
};

struct SynthReport {
  std::filesystem::path out;
  int views = 0, test_views = 0, relit_views = 0;
  double seconds = 0;
  Json json() const;
};

// Folders and names as docs/synth.md says. Usage errors: unknown names, values out of range, a folder that
// holds something. Interrupted Error: the images written so far are whole.
SynthReport make_capture(const SynthRequest&, Progress&);

// The scene that the request describes, under its training light as a camera at azimuth 0 sees it.
SyntheticScene scene_of(const SynthRequest&);

}  // namespace cei3d

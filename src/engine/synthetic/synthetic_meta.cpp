// SPDX-License-Identifier: Apache-2.0
#include "engine/synthetic/synthetic_meta.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/synthetic/truth_files.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

Json material_json(const SyntheticScene& scene, bool lambert) {
  Json regions = Json::object();
  for (size_t i = 0; i < scene.finishes.size(); ++i) {
    const Finish& f = scene.finishes[i];
    Json& r = regions[scene.shape.regions[i]];
    r = {{"roughness", f.material.roughness},
         {"specular", f.material.specular},
         {"metalness", f.material.metalness},
         {"color_linear", vector_json(f.color)}};
    if (f.second_color) r["second_color_linear"] = vector_json(*f.second_color);
  }
  return {{"model",
           fmt::format(
               "GGX microfacets (alpha = roughness^2, Smith masking, Fresnel's term of index 1.5, F0 = "
               "(1 - metalness) 0.08 specular + metalness albedo, F90 = (1 - metalness) min(2 specular, 1) + "
               "metalness) over a {} diffuse base (1 - "
               "metalness) albedo / pi",
               lambert ? "Lambertian" : "Burley")},
          {"regions", regions}};
}

Json lighting_json(const SynthRequest& r, const SyntheticScene& scene,
                   const std::vector<std::string>& relight) {
  Json lobes = Json::array();
  for (const SgLobe& l : scene.light.lobes)
    lobes.push_back({l.axis.x, l.axis.y, l.axis.z, l.lambda, l.mu.x, l.mu.y, l.mu.z});
  Json maps = Json::array();
  for (const std::string& name : relight) maps.push_back("envs/" + name + ".hdr");
  Json out{
      {"train_env", "envs/" + r.light + ".hdr"},
      {"relight_envs", maps},
      {"tint", vector_json(r.light_tint)},
      {"strength", r.light_strength},
      {"turns", r.light_turns},
      {"lobes", lobes},
      {"lobes_note", "rows of axis (towards the light), sharpness, linear radiance at the peak"},
      {"convention",
       "lat-long, linear Rec. 709; pixel (column i, row j) of W x H: theta = pi (j + 0.5) / H from +Z, "
       "phi = 2 pi (0.5 - (i + 0.5) / W), direction towards the light = (sin theta cos phi, sin theta sin "
       "phi, cos theta)"}};
  if (r.light_turns)
    out["turntable"] =
        "The light turns with the camera about +Z: in the view of a camera at azimuth a = atan2(y, x) of its "
        "position, the radiance from direction w is L(Rz(-a) w), L the stored map. Relit views do not turn.";
  return out;
}

}  // namespace

Json capture_meta(const SynthRequest& r, const SyntheticScene& scene,
                  const std::vector<std::string>& relight) {
  return {
      {"scene", r.out.filename().string()},
      {"object", r.shape},
      {"resolution", {r.width, r.height}},
      {"world",
       "right handed, Z up; object inside the unit sphere at the origin; camera-to-world matrices in OpenGL "
       "convention (camera looks along -Z, +Y up, +X right); pixel centers at +0.5, row 0 on top"},
      {"images",
       "8-bit RGBA PNG, straight alpha, RGB = sRGB of the linear radiance clipped to [0, 1]; RGB = 0 where "
       "alpha = 0"},
      {"material", material_json(scene, r.diffuse == Diffuse::lambert)},
      {"lighting", lighting_json(r, scene, relight)},
      {"gt",
       {{"albedo", "gt/albedo: sRGB, straight alpha"},
        {"normal", "gt/normal: 16-bit (n + 1) / 2, world; 0 is background"},
        {"depth", fmt::format("gt/depth: 16-bit, depth along the camera axis = value / {}", kDepthScale)},
        {"roughness", "gt/roughness, gt/metalness: gray = 255 x value, straight alpha"},
        {"mask", "gt/mask: share of the pixel that the object covers"},
        {"mesh", "mesh_gt.ply"}}},
      {"render", {{"samples", r.samples}, {"bounces", r.bounces}, {"noise", r.noise}, {"seed", r.seed}}},
      {"edits", {{"relight", {{"gt_test_views", "every second one"}}}}}};
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/item.h"

#include <algorithm>

#include "core/base/name_distance.h"
#include "engine/session/requests.h"
#include "model/light/light_turns.h"

namespace cei3d {
namespace {

const std::vector<std::string> kKeeps{"all", "project", "exports"};
const std::vector<std::string> kKinds{"glb",  "gltf", "obj", "usdz", "ply",
                                      "html", "hdr",  "exr", "npy",  "json"};

// The place of a word in a list. Error: it is not there.
size_t place_of(const std::string& word, const std::vector<std::string>& words, const std::string& what) {
  const auto at = std::find(words.begin(), words.end(), word);
  if (at != words.end()) return size_t(at - words.begin());
  fail("{}: there is no '{}'; the nearest is '{}'.", what, word, nearest_name(word, words));
}

std::vector<std::string> words_of(JsonReader& r, const char* key, const std::vector<std::string>& known) {
  std::vector<std::string> out;
  if (!r.has(key)) return out;
  for (const Json& j : r.array(key)) {
    if (!j.is_string()) fail("{}: '{}' is a list of words.", r.what(), key);
    place_of(j.get<std::string>(), known, fmt::format("{}, '{}'", r.what(), key));
    out.push_back(j.get<std::string>());
  }
  return out;
}

int count_of(JsonReader& r, const char* key, int otherwise, int min, int max) {
  const int n = r.optional(key, otherwise);
  if (n < min || n > max) fail("{}: '{}' is {}; it is {} to {}.", r.what(), key, n, min, max);
  return n;
}

void read_options(JsonReader r, BatchItem& item) {
  constexpr int kMany = 1000000;
  ReconstructOptions& o = item.options;
  o.preset = r.optional("preset", o.preset);
  place_of(o.preset, {"fast", "balanced", "paper"}, r.what());
  o.seconds = r.optional("seconds", o.seconds);
  o.iterations = count_of(r, "iterations", 0, 0, 100 * kMany);
  if (o.seconds < 0 || (o.seconds > 0 && o.iterations > 0))
    fail("{}: give 'iterations' or 'seconds', which are more than 0.", r.what());
  o.joint_steps = count_of(r, "joint", -1, -1, kMany);
  o.seed = r.optional("seed", o.seed);
  o.downscale = count_of(r, "downscale", 0, 0, 64);
  o.test_every = count_of(r, "test_every", o.test_every, 0, kMany);
  o.views = count_of(r, "views", 0, 0, kMany);
  const std::string light = r.optional("light", std::string("auto"));
  place_of(light, {"auto", "world", "camera", "turntable"}, r.what() + ", 'light'");
  o.light = light_motion_named(light);
  const auto color = light_color_from(r.optional("light_color", std::string("near-white")));
  if (!color) fail("{}: 'light_color' is free, near-white or three numbers above 0.", r.what());
  o.light_color = *color;
  const std::string poses = r.optional("poses", std::string("auto"));
  place_of(poses, {"auto", "given"}, r.what() + ", 'poses'");
  o.refine_poses = poses == "auto";
  const std::string exposures = r.optional("exposures", std::string("auto"));
  place_of(exposures, {"auto", "given"}, r.what() + ", 'exposures'");
  o.fit_exposures = exposures == "auto";
  const std::string format = r.optional("format", std::string());
  const bool strict = r.optional("strict", false);
  r.finish();
  item.capture_options = {format, o.test_every, o.views, strict};
}

void read_variants(const Json& object, const std::string& what, BatchItem& item) {
  if (!object.is_object()) fail("{}: 'variants' is an object of names and lists of edits.", what);
  for (const auto& [name, edits] : object.items()) {
    if (!is_batch_id(name) || name == "original")
      fail("{}: a variant cannot be called '{}'; use letters, digits, '-' and '_'.", what, name);
    if (!edits.is_array()) fail("{}: variant '{}' is a list of edits.", what, name);
    for (const Json& edit : edits)
      JsonReader(edit, fmt::format("{}, variant '{}'", what, name)).require<std::string>("edit");
    item.variants.push_back({name, edits});
  }
}

void read_asset(JsonReader& r, BatchItem& item) {
  item.exports = words_of(r, "export", kKinds);
  if (!r.has("export")) item.exports = {"glb", "html"};
  item.purpose = r.optional("for", std::string());
  if (!item.purpose.empty() && !export_for_from_name(item.purpose))
    fail("{}: 'for' is web, ar or dcc.", r.what());
  item.unit_scale = r.optional("unit_scale", 1.0);
  if (!(item.unit_scale >= kMinExportLength && item.unit_scale <= kMaxExportLength))
    fail("{}: 'unit_scale' is meters per unit, {} to {}.", r.what(), kMinExportLength, kMaxExportLength);
  item.frames = count_of(r, "frames", item.frames, 1, 1000);
  item.asset = {{"export", item.exports}, {"for", item.purpose}, {"unit_scale", item.unit_scale}};
}

bool needs_capture(const BatchItem& item) {
  return std::any_of(item.steps.begin(), item.steps.end(), [](const std::string& s) { return s != "stub"; });
}

Json without(Json object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) object.erase(key);
  return object;
}

}  // namespace

const std::vector<std::string>& batch_step_names() {
  static const std::vector<std::string> names{"check",  "reconstruct", "figures",
                                              "export", "turntable",   "stub"};
  return names;
}

bool is_batch_id(const std::string& id) {
  constexpr size_t kLongest = 100;
  const auto good = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '_' || c == '-'; };
  return !id.empty() && id.size() <= kLongest && id[0] != '.' && std::all_of(id.begin(), id.end(), good);
}

Json with_defaults(const Json& defaults, const Json& line) {
  Json out = defaults;
  for (const auto& [key, value] : line.items())
    if (key == "options" && value.is_object() && out.contains(key))
      out[key].update(value);
    else
      out[key] = value;
  return out;
}

BatchItem batch_item_from(const Json& line, const std::string& what) {
  JsonReader r(line, what);
  BatchItem item;
  item.id = r.require<std::string>("id");
  if (!is_batch_id(item.id))
    fail("{}: '{}' cannot be an id, which is a folder's name: letters, digits, '.', '_' and '-'.", what,
         item.id);
  item.capture = r.optional("capture", std::string());
  if (r.has("options")) read_options(r.object("options"), item);
  item.steps = words_of(r, "steps", batch_step_names());
  if (!r.has("steps")) item.steps = {"check", "reconstruct", "figures", "export"};
  read_asset(r, item);
  if (r.has("variants")) read_variants(r.member("variants"), what, item);
  item.keep = BatchKeep(place_of(r.optional("keep", kKeeps[1]), kKeeps, what + ", 'keep'"));
  item.stub_seconds = r.optional("stub_seconds", 0.0);
  item.planned = r.has("planned");
  item.tags = r.has("tags") ? r.member("tags") : Json::object();
  r.finish();
  if (item.capture.empty() && needs_capture(item)) fail("{} names no 'capture'.", what);
  const Json options = line.value("options", Json::object());
  item.capture_reading = {{"format", item.capture_options.format},
                          {"test_every", item.capture_options.test_every},
                          {"views", item.capture_options.views},
                          {"strict", item.capture_options.strict}};
  item.reconstruction = without(options, {"format", "test_every", "views", "strict"});
  return item;
}

}  // namespace cei3d

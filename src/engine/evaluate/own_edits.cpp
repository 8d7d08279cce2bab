// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/own_edits.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"
#include "engine/capture/capture_images.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Other programs write these files, with more in them than is read here.
Json read_object(const fs::path& file) {
  Json j = parse_json(read_file(file));
  if (!j.is_object() || !j.contains("view") || !j.at("view").is_string())
    fail("{} should be a JSON object that names its \"view\".", file.string());
  return j;
}

EditTruth truth_in(const fs::path& folder) {
  EditTruth t{folder / "gt", fs::exists(folder / "mask/test") ? folder / "mask/test" : folder / "mask"};
  if (fs::exists(t.pictures) && fs::exists(t.masks)) return t;
  return {};
}

// Pixel indices, whose centers are at +0.5.
std::vector<Vec2<double>> clicks_in(const Json& j, const char* key, const fs::path& file) {
  std::vector<Vec2<double>> clicks;
  if (!j.contains(key)) return clicks;
  for (const Json& p : j.at(key)) {
    if (!p.is_array() || p.size() != 2 || !p[0].is_number() || !p[1].is_number())
      fail("'{}' of {} should be a list of [x, y].", key, file.string());
    clicks.push_back({p[0].get<double>() + 0.5, p[1].get<double>() + 0.5});
  }
  return clicks;
}

PartTrial part_in(const fs::path& folder) {
  const fs::path file = folder / "prompts.json";
  const Json j = read_object(file);
  PartTrial t;
  t.command.view = j.at("view").get<std::string>();
  t.command.positive = clicks_in(j, "positive", file);
  t.command.negative = clicks_in(j, "negative", file);
  if (t.command.positive.empty()) fail("{} has no \"positive\" clicks.", file.string());
  t.command.effects.color = j.value("target_color_srgb", "#c04020");
  t.command.effects.replace = true;
  t.truth = truth_in(folder);
  return t;
}

}  // namespace

OwnEdits own_edits(const fs::path& capture) {
  const fs::path edits = (fs::is_directory(capture) ? capture : capture.parent_path()) / "edits";
  OwnEdits own;
  if (const fs::path paint = edits / "paint"; fs::exists(paint / "view.json")) {
    own.paint =
        PaintStroke{read_object(paint / "view.json").at("view").get<std::string>(), paint / "scribble.png"};
    own.paint_truth = truth_in(paint);
  }
  if (fs::exists(edits / "part/prompts.json")) own.part = part_in(edits / "part");
  return own;
}

PaintStroke made_scribble(const Capture& capture, const fs::path& file) {
  const std::vector<View> train = views_of(capture, Split::train);
  if (train.empty()) fail("The capture has no training view to paint on.");
  const Mask mask = load_mask(train.front());
  double sum_x = 0, sum_y = 0, area = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.object[size_t(y) * mask.width + x]) sum_x += x, sum_y += y, ++area;
  if (area == 0) fail("View {} shows nothing of the object.", train.front().name);
  const double radius = 0.25 * std::sqrt(area / M_PI);
  Image scribble(mask.width, mask.height, 4);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      const double r = std::hypot(x - sum_x / area, y - sum_y / area);
      if (r > radius) continue;
      const Vec3f color = r < 0.5 * radius ? Vec3f{0.12f, 0.27f, 0.75f} : Vec3f{0.78f, 0.12f, 0.16f};
      for (int c = 0; c < 3; ++c) scribble.at(x, y)[c] = color[c];
      scribble.at(x, y)[3] = 1;
    }
  write_png(file, scribble);
  return {train.front().name, file};
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/image/resample.h"
#include "core/math/color.h"
#include "core/math/quantile.h"
#include "engine/capture/doctor.h"
#include "engine/capture/local_fit.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

constexpr size_t kNeighbors = 6;
constexpr double kJump = 0.5;         // natural logarithm: 1.6 times as bright as the neighbors
constexpr double kOutlierFactor = 5;  // a photograph stands out beyond this many median deviations
constexpr double kBlurred = 0.4;      // maximum sharpness of a blurred photograph, relative to its neighbors'
constexpr double kSame = 0.004;       // root mean square difference of thumbnails, linear
constexpr double kExposures = 1.25;   // ratio of the camera's own notes that matters

// Second differences at the image's own resolution, where all five pixels are of the object.
double sharpness_of(const Image& rgba) {
  const auto opaque = [&](int x, int y) { return rgba.at(x, y)[3] > 0.99f; };
  double sum = 0, level = 0;
  for (int y = 1; y + 1 < rgba.height; ++y)
    for (int x = 1; x + 1 < rgba.width; ++x) {
      if (!opaque(x, y) || !opaque(x - 1, y) || !opaque(x + 1, y) || !opaque(x, y - 1) || !opaque(x, y + 1))
        continue;
      const double here = luminance(rgba.rgb(x, y));
      sum += std::abs(4 * here - luminance(rgba.rgb(x - 1, y)) - luminance(rgba.rgb(x + 1, y)) -
                      luminance(rgba.rgb(x, y - 1)) - luminance(rgba.rgb(x, y + 1)));
      level += here;
    }
  return level > 0 ? sum / level : 0;
}

double brightness_of(const Image& rgba) {
  double sum = 0, n = 0;
  for (int y = 0; y < rgba.height; ++y)
    for (int x = 0; x < rgba.width; ++x)
      if (rgba.at(x, y)[3] > 0.5f) sum += std::log(std::max(luminance(rgba.rgb(x, y)), 1e-3f)), ++n;
  return n > 0 ? sum / n : 0;
}

void fill_thumbnail(const Image& rgba, PhotoLook& look) {
  look.thumbnail.assign(size_t(kThumbnail) * kThumbnail * 3, 0);
  look.background.assign(size_t(kThumbnail) * kThumbnail, 1);
  std::vector<double> n(look.background.size(), 0);
  for (int y = 0; y < rgba.height; ++y)
    for (int x = 0; x < rgba.width; ++x) {
      const size_t i =
          size_t(y * kThumbnail / rgba.height) * kThumbnail + size_t(x * kThumbnail / rgba.width);
      for (size_t c = 0; c < 3; ++c) look.thumbnail[3 * i + c] += std::min(rgba.at(x, y)[c], 1.0f);
      if (rgba.at(x, y)[3] != 0) look.background[i] = 0;
      ++n[i];
    }
  for (size_t i = 0; i < look.thumbnail.size(); ++i) look.thumbnail[i] /= float(std::max(n[i / 3], 1.0));
}

// The photographs from the nearest places.
std::vector<size_t> neighbors_of(std::span<const JudgedPhoto> photos, size_t i) {
  std::vector<std::pair<double, size_t>> all;
  for (size_t k = 0; k < photos.size(); ++k)
    if (k != i) all.push_back({length(photos[k].view->camera.center - photos[i].view->camera.center), k});
  const size_t n = std::min(kNeighbors, all.size());
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(n), all.end());
  std::vector<size_t> out;
  for (size_t k = 0; k < n; ++k) out.push_back(all[k].second);
  return out;
}

// Value of each photograph minus the median of its neighbors'.
template <class F>
std::vector<double> against_neighbors(std::span<const JudgedPhoto> photos, F value) {
  std::vector<double> out;
  for (size_t i = 0; i < photos.size(); ++i) {
    std::vector<double> around;
    for (const size_t k : neighbors_of(photos, i)) around.push_back(value(photos[k]));
    out.push_back(around.empty() ? 0 : value(photos[i]) - median(around));
  }
  return out;
}

double median_deviation(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return median(values);
}

// An object's brightness changes gradually with the direction: a jump is the residual of a local linear fit.
std::vector<double> jumps_of_brightness(std::span<const JudgedPhoto> photos, Vec3d center) {
  std::vector<Vec3d> directions;
  std::vector<double> brightness;
  for (const JudgedPhoto& p : photos) {
    const Vec3d offset = p.view->camera.center - center;
    directions.push_back(offset * (1 / std::max(length(offset), 1e-12)));
    brightness.push_back(p.look->brightness);
  }
  return against_nearby(directions, brightness);
}

void check_exposures(std::span<const JudgedPhoto> photos, Vec3d center, std::vector<Finding>& findings) {
  const auto differences = jumps_of_brightness(photos, center);
  const double limit = std::max(kJump, kOutlierFactor * median_deviation(differences));
  std::vector<std::string> names, texts;
  for (size_t i = 0; i < photos.size(); ++i)
    if (std::abs(differences[i]) > limit) {
      names.push_back(photos[i].view->name);
      texts.push_back(fmt::format("{} ({:.2g} times as bright)", names.back(), std::exp(differences[i])));
    }
  if (!names.empty())
    findings.push_back(
        {Severity::warning,
         fmt::format("{} of {} photographs are much brighter or darker than their neighbors: {}.",
                     names.size(), photos.size(), some_names(texts)),
         "Lock exposure and white balance, or remove these views.", names});
  std::vector<double> stated;
  for (const JudgedPhoto& p : photos)
    if (p.look->notes.exposure) stated.push_back(*p.look->notes.exposure);
  if (stated.size() < 2) return;
  const auto [smallest, largest] = std::minmax_element(stated.begin(), stated.end());
  if (*largest > kExposures * *smallest)
    findings.push_back(
        {Severity::note,
         fmt::format("By the camera's own notes (EXIF) exposures differ by a factor of {:.2g}.",
                     *largest / *smallest),
         "Lock exposure and white balance; light and albedo are estimated from all photographs together."});
}

// What a camera chooses for one photograph need not be what it chooses for the next.
void check_white_balance(std::span<const JudgedPhoto> photos, std::vector<Finding>& findings) {
  std::vector<std::string> names;
  for (const JudgedPhoto& p : photos)
    if (p.look->notes.auto_white == true) names.push_back(p.view->name);
  if (names.empty()) return;
  findings.push_back(
      {Severity::note,
       fmt::format("By the camera's own notes (EXIF) it chose the white balance of {} of {} photographs "
                   "itself, so their colors may differ: {}.",
                   names.size(), photos.size(), some_names(names)),
       "Lock the white balance; `reconstruct` makes up for constant factors of the channels.", names});
}

void check_blur(std::span<const JudgedPhoto> photos, std::vector<Finding>& findings) {
  const auto differences = against_neighbors(
      photos, [](const JudgedPhoto& p) { return std::log(std::max(p.look->sharpness, 1e-6)); });
  const double limit = std::max(-std::log(kBlurred), kOutlierFactor * median_deviation(differences));
  std::vector<std::string> names;
  for (size_t i = 0; i < photos.size(); ++i)
    if (differences[i] < -limit) names.push_back(photos[i].view->name);
  if (!names.empty())
    findings.push_back({Severity::warning,
                        fmt::format("{} of {} photographs are blurred against their neighbors: {}.",
                                    names.size(), photos.size(), some_names(names)),
                        "Remove these views, or take them again: longer depth of field, shorter exposure.",
                        names, removal_of(names)});
}

double difference_of(const PhotoLook& a, const PhotoLook& b) {
  double sum = 0;
  for (size_t i = 0; i < a.thumbnail.size(); ++i) sum += square(double(a.thumbnail[i]) - b.thumbnail[i]);
  return std::sqrt(sum / double(a.thumbnail.size()));
}

// Photographs without detail are alike from everywhere.
double contrast_of(const PhotoLook& look) {
  double mean = 0, sum = 0;
  for (const float v : look.thumbnail) mean += v / double(look.thumbnail.size());
  for (const float v : look.thumbnail) sum += square(v - mean);
  return std::sqrt(sum / double(look.thumbnail.size()));
}

// Finds the same image at two poses, or twice at one. Neighboring photographs of a smooth object are similar,
// too: thumbnails of a duplicate are nearly equal, and its pixels are the same.
void check_duplicates(std::span<const JudgedPhoto> photos, std::vector<Finding>& findings) {
  std::vector<std::string> pairs, both, second;
  for (size_t i = 0; i < photos.size(); ++i)
    for (size_t k = 0; k < i; ++k) {
      const PhotoLook &a = *photos[i].look, &b = *photos[k].look;
      if (difference_of(a, b) > kSame * std::min(1.0, 10 * contrast_of(a))) continue;
      if (read_image(photos[i].view->image_path).data != read_image(photos[k].view->image_path).data)
        continue;
      pairs.push_back(fmt::format("{} = {}", photos[i].view->name, photos[k].view->name));
      second.push_back(photos[i].view->name);
      both.insert(both.end(), {photos[i].view->name, photos[k].view->name});
      break;
    }
  if (!pairs.empty())
    findings.push_back({Severity::warning,
                        fmt::format("{} of {} photographs are there twice: {}.", pairs.size(), photos.size(),
                                    some_names(pairs)),
                        "Remove the copies; where their poses differ, one of the two is wrong.", both,
                        removal_of(second)});
}

// Standard deviation over photographs of what is background in nearly all of them, and over its places.
void check_background(std::span<const JudgedPhoto> photos, Vec3d center, std::vector<Finding>& findings) {
  double widest = 1;
  const Vec3d first = normalize(photos[0].view->camera.center - center);
  for (const JudgedPhoto& p : photos)
    widest = std::min(widest, dot(first, normalize(p.view->camera.center - center)));
  if (widest > 0.5) return;  // cameras within 60 degrees
  std::vector<double> over_time, levels;
  for (size_t i = 0; i < photos[0].look->background.size(); ++i) {
    double n = 0, sum = 0, squares = 0;
    for (const JudgedPhoto& p : photos) {
      if (!p.look->background[i]) continue;
      const double v = p.look->thumbnail[3 * i + 1];
      ++n, sum += v, squares += v * v;
    }
    if (n < 0.8 * double(photos.size())) continue;
    levels.push_back(sum / n);
    over_time.push_back(std::sqrt(std::max(0.0, squares / n - square(sum / n))));
  }
  if (levels.size() < 20) return;
  const auto [darkest, brightest] = std::minmax_element(levels.begin(), levels.end());
  const double range = *brightest - *darkest;
  if (range > 0.1 && median(over_time) < 0.05 * range)
    findings.push_back(
        {Severity::note,
         "The background does not move with the cameras: the object was turned, and the light with it "
         "against the object.",
         "Say that the light turns as on a turntable when it is reconstructed, or let the reconstruction "
         "find out."});
}

// The mean colors of blocks, whatever the mask says.
Image small_image(const Image& rgba) {
  Image rgb(rgba.width, rgba.height, 3);
  for (size_t i = 0; i < rgb.data.size(); ++i) rgb.data[i] = rgba.data[i / 3 * 4 + i % 3];
  return downscale(rgb, reduction_of(rgba.width, rgba.height));
}

}  // namespace

PhotoLook look_at_photo(const View& view, const Image& rgba) {
  PhotoLook look;
  look.seen = true;
  look.brightness = brightness_of(rgba);
  look.sharpness = sharpness_of(rgba);
  look.notes = read_image_exif(view.image_path);
  look.small = small_image(rgba);
  fill_thumbnail(rgba, look);
  return look;
}

void check_photographs(std::span<const JudgedPhoto> photos, Vec3d center, std::vector<Finding>& findings) {
  if (photos.size() < 4) return;
  check_exposures(photos, center, findings);
  check_white_balance(photos, findings);
  check_blur(photos, findings);
  check_duplicates(photos, findings);
  check_background(photos, center, findings);
}

}  // namespace cei3d

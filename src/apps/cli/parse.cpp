// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/parse.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/base/error.h"

namespace cei3d {
namespace {

[[noreturn]] void bad_duration(const std::string& text) {
  fail_usage("--time '{}' is not a duration; write seconds or a sum like 90s, 10m, 1h30m.", text);
}

double unit_seconds(char unit, const std::string& text) {
  if (unit == 's') return 1;
  if (unit == 'm') return 60;
  if (unit == 'h') return 3600;
  bad_duration(text);
}

}  // namespace

double parse_duration(const std::string& text) {
  double total = 0;
  const char *p = text.data(), *end = p + text.size();
  if (p == end) bad_duration(text);
  while (p < end) {
    double value = 0;
    const auto [after, error] = std::from_chars(p, end, value);
    if (error != std::errc() || value < 0) bad_duration(text);
    total += value * (after < end ? unit_seconds(*after, text) : 1);
    p = after < end ? after + 1 : end;
  }
  if (!(total > 0 && total < 1e9)) bad_duration(text);
  return total;
}

std::string duration_text(double seconds) {
  const long s = std::lround(seconds);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

double parse_length(const std::string& text, const std::string& option) {
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(after, text.data() + text.size());
  for (const auto& [name, meters] :
       {std::pair("", 1.0), {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}})
    if (unit == name && error == std::errc() && value > 0 && value < 1e9) return value * meters;
  fail_usage("{} '{}' is not a length; write meters or a number with m, cm, mm or in, for example 30cm.",
             option, text);
}

ImageExtent parse_size(const std::string& text) {
  ImageExtent size;
  char x = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%d%c%d%c", &size.width, &x, &size.height, &rest) != 3 || x != 'x' ||
      size.width < 1 || size.height < 1 || size.width > 65535 || size.height > 65535)
    fail_usage("--size '{}' is not an image size; write WIDTHxHEIGHT in pixels, for example 800x600.", text);
  return size;
}

std::vector<Channel> parse_channels(const std::string& text) {
  std::vector<Channel> channels;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) {
    const std::optional<Channel> c = channel_from_name(word);
    if (!c)
      fail_usage(
          "Unknown channel '{}'. Channels are rgb, albedo, diffuse, specular, normal, depth, roughness, "
          "metalness, mask.",
          word);
    channels.push_back(*c);
  }
  if (channels.empty()) fail_usage("--channels is empty; write for example --channels rgb,normal.");
  return channels;
}

EnvConvention parse_env_convention(const std::string& text) {
  const std::optional<EnvConvention> c = env_convention_from_name(text);
  if (!c)
    fail_usage("Unknown environment convention '{}'. Conventions are zup, yup, mitsuba, blender.", text);
  return *c;
}

std::vector<double> parse_numbers(const std::string& text, size_t count, const std::string& option) {
  std::vector<double> numbers;
  const char *p = text.data(), *end = p + text.size();
  for (bool more = true; more;) {
    double value = 0;
    const auto [after, error] = std::from_chars(p, end, value);
    const bool ends = after == end;
    if (error != std::errc() || !std::isfinite(value) || (!ends && *after != ',')) {
      numbers.clear();
      break;
    }
    numbers.push_back(value);
    more = !ends;
    p = ends ? end : after + 1;
  }
  if (numbers.size() != count)
    fail_usage("{} '{}' must be {} numbers separated by commas, for example {}.", option, text, count,
               count == 2 ? "120.5,88" : "0.1,-0.25,1");
  return numbers;
}

std::vector<Vec2<double>> parse_pixels(const std::vector<std::string>& texts, const std::string& option) {
  std::vector<Vec2<double>> pixels;
  for (const std::string& text : texts) {
    const std::vector<double> v = parse_numbers(text, 2, option);
    pixels.push_back({v[0], v[1]});
  }
  return pixels;
}

void parse_split(const std::string& text, ReconstructOptions& options) {
  const size_t colon = text.find(':');
  const std::string how = text.substr(0, colon);
  if (colon == std::string::npos || (how != "every" && how != "random"))
    fail_usage("--split '{}' should be every:N or random:SHARE, for example random:0.1.", text);
  const double value = parse_numbers(text.substr(colon + 1), 1, "--split " + how)[0];
  if (how == "random") {
    if (!(value > 0 && value < 1)) fail_usage("--split '{}': a share lies between 0 and 1.", text);
    options.test_share = value;
    return;
  }
  if (!(value >= 2 && value <= 1e6 && value == std::floor(value)))
    fail_usage("--split '{}': every Nth view needs a whole number of 2 or more.", text);
  options.test_every = int(value);
}

CameraChoice parse_cameras(const std::string& text) {
  if (text.ends_with(".json") && is_camera_file(text)) return CameraFile{text};
  const CaptureSpec spec = parse_capture_spec(text);
  return CaptureViews{spec.path, spec.split};
}

}  // namespace cei3d

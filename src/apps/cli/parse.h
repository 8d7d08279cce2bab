// SPDX-License-Identifier: Apache-2.0
// Parses values of command line options. All errors are usage errors that name the option.
#pragma once

#include <string>
#include <vector>

#include "engine/session/requests.h"

namespace cei3d {

double parse_duration(const std::string& text);  // "90", "90s", "10m", "1h30m": seconds
std::string duration_text(double seconds);       // "0:07", "12:30", "1:02:03"
double parse_length(const std::string& text, const std::string& option);  // "0.3", "0.30m", "30cm": meters
struct ImageExtent {
  int width = 0, height = 0;
};
ImageExtent parse_size(const std::string& text);               // "800x600"
std::vector<Channel> parse_channels(const std::string& text);  // "rgb,normal"
EnvConvention parse_env_convention(const std::string& text);
// "1.5,-2,0": exactly `count` finite numbers. option: its name, for the error.
std::vector<double> parse_numbers(const std::string& text, size_t count, const std::string& option);
// "120.5,88" each: (column, row).
std::vector<Vec2<double>> parse_pixels(const std::vector<std::string>& texts, const std::string& option);
// "every:8", "random:0.1": which views are held out. Into test_every or test_share.
void parse_split(const std::string& text, ReconstructOptions&);
// A FILE.json with cameras as `render` writes it, or a capture with or without ":split".
CameraChoice parse_cameras(const std::string& text);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/session/photograph_size.h"

#include <algorithm>
#include <cmath>

namespace cei3d {
namespace {

constexpr double kMaxPixels = 60e6;  // maximum number of pixels of the object in all training views
// Rough bounds: networks and meshes; a pixel of the object; any pixel of a view, which has a mask. 87 views
// of 12 megapixels, used at 1/3 of their size, took 1.8 GB.
constexpr double kBaseBytes = 0.5e9, kObjectBytes = 22, kPixelBytes = 1;
// Memory per pixel of the photograph that is being read, at its full size.
constexpr double kDecodedBytes = 60;

struct Pixels {
  double all = 0, object = 0;  // of all training views
  double largest = 0;          // of one view
};

Pixels pixels_of(const CaptureReport& report) {
  Pixels p;
  for (const SplitReport& s : report.splits) {
    if (s.split != Split::train) continue;
    p.largest = double(s.size.width) * s.size.height;
    p.all = s.views * p.largest;
    p.object = p.all * s.coverage;
  }
  return p;
}

}  // namespace

int default_downscale(const CaptureReport& report) {
  return std::max(1, int(std::ceil(std::sqrt(pixels_of(report).object / kMaxPixels))));
}

double reconstruction_gib(const CaptureReport& report, int downscale) {
  const Pixels p = pixels_of(report);
  const double share = 1 / double(downscale * downscale);
  return (kBaseBytes + share * (kObjectBytes * p.object + kPixelBytes * p.all) + kDecodedBytes * p.largest) /
         double(1 << 30);
}

}  // namespace cei3d

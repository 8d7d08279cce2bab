// SPDX-License-Identifier: Apache-2.0
#include "engine/io/color_profile.h"

#include <lcms2.h>

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "core/base/error.h"

namespace cei3d {
namespace {

struct Close {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, Close>;
struct DeleteTransform {
  void operator()(void* transform) const { cmsDeleteTransform(transform); }
};
using Transform = std::unique_ptr<void, DeleteTransform>;

Profile opened(const std::string& bytes) {
  return Profile(cmsOpenProfileFromMem(bytes.data(), cmsUInt32Number(bytes.size())));
}

// sRGB's primaries without its curve.
Profile linear_srgb() {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
  cmsToneCurve* line = cmsBuildGamma(nullptr, 1.0);
  cmsToneCurve* curves[3] = {line, line, line};
  Profile profile(cmsCreateRGBProfile(&white, &primaries, curves));
  cmsFreeToneCurve(line);
  return profile;
}

// Null: the profile lacks what it takes.
Transform to_linear_srgb(const Profile& from) {
  const Profile to = linear_srgb();
  return Transform(cmsCreateTransform(from.get(), TYPE_RGB_FLT, to.get(), TYPE_RGB_FLT,
                                      INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE));
}

}  // namespace

std::string jpeg_profile(const std::string& bytes) {
  static constexpr char kMark[] = "ICC_PROFILE";  // and its zero
  std::map<int, std::string> parts;
  for (size_t at = 2; at + 4 <= bytes.size() && uint8_t(bytes[at]) == 0xff;) {
    const int marker = uint8_t(bytes[at + 1]);
    const size_t length = size_t(uint8_t(bytes[at + 2])) << 8 | uint8_t(bytes[at + 3]);
    if (marker == 0xda || length < 2 || at + 2 + length > bytes.size()) break;
    if (marker == 0xe2 && length > 16 && bytes.compare(at + 4, sizeof(kMark), kMark, sizeof(kMark)) == 0)
      parts[uint8_t(bytes[at + 16])] = bytes.substr(at + 18, length - 16);
    at += 2 + length;
  }
  std::string profile;
  for (const auto& [number, part] : parts) profile += part;
  return profile;
}

ProfileKind profile_kind(const std::string& bytes) {
  const Profile profile = opened(bytes);
  if (!profile || cmsGetColorSpace(profile.get()) != cmsSigRgbData) return ProfileKind::unusable;
  char text[256] = {};
  cmsGetProfileInfoASCII(profile.get(), cmsInfoDescription, "en", "US", text, sizeof(text) - 1);
  if (std::string(text).find("sRGB") != std::string::npos) return ProfileKind::srgb;
  return to_linear_srgb(profile) ? ProfileKind::other : ProfileKind::unusable;
}

Image linear_by_profile(Image image, const std::string& bytes) {
  const Profile from = opened(bytes);
  const Transform transform = to_linear_srgb(from);
  if (!transform) fail("A color profile cannot be used; convert the images to sRGB.");
  const auto stride = size_t(image.channels);
  std::vector<float> row(3 * size_t(image.width));
  for (int y = 0; y < image.height; ++y) {
    float* pixels = image.at(0, y);
    for (size_t x = 0; x < size_t(image.width); ++x) std::copy_n(pixels + stride * x, 3, &row[3 * x]);
    cmsDoTransform(transform.get(), row.data(), row.data(), cmsUInt32Number(image.width));
    for (size_t i = 0; i < row.size(); ++i) pixels[stride * (i / 3) + i % 3] = std::max(row[i], 0.0f);
  }
  return image;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/export/asset.h"

#include <cmath>
#include <functional>

#include "core/base/parallel.h"
#include "core/math/color.h"
#include "core/math/shading.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/io/webp_file.h"

namespace cei3d {
namespace {

constexpr int kQuality = 92;  // quality of lossy pictures, 0 to 100

Picture encoded(const Image& image, const std::string& name, PictureKind kind) {
  if (kind == PictureKind::jpeg) return {name + ".jpg", encode_jpeg(image, kQuality), kind};
  if (kind == PictureKind::webp) return {name + ".webp", encode_webp(image, kQuality), kind};
  return {name + ".png", encode_png(image, 8), kind};
}

Picture exact(const Image& image, const std::string& name, PictureKind kind) {
  if (kind == PictureKind::webp) return {name + ".webp", encode_webp(image, kLossless), kind};
  return encoded(image, name, PictureKind::png);
}

Image srgb(const Image& linear) {
  Image out(linear.width, linear.height, 3);
  parallel_ranges(int(out.data.size()), 1 << 16, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) out.data[size_t(i)] = srgb_from_linear(linear.data[size_t(i)]);
  });
  return out;
}

// AssetPictures::specular.
Image specular_picture(const Image& strength) {
  Image out(strength.width, strength.height, 4);
  for (size_t i = 0; i < strength.data.size(); ++i) {
    const float s = strength.data[i], color = srgb_from_linear(max(s, kUsualSpecular));
    const float texel[] = {color, color, color, f90_of(s, 0.0f)};
    std::copy(std::begin(texel), std::end(texel), &out.data[4 * i]);
  }
  return out;
}

}  // namespace

const char* Picture::mime() const {
  switch (kind) {
    case PictureKind::jpeg:
      return "image/jpeg";
    case PictureKind::webp:
      return "image/webp";
    case PictureKind::png:
      break;
  }
  return "image/png";
}

AssetPictures encode(const Textures& t, PictureKind kind) {
  AssetPictures out;
  out.middle_specular = t.middle_specular;
  const std::function<void()> jobs[] = {
      [&] { out.normal = exact(t.normal, "normal", kind); },
      [&] { out.base_color = encoded(srgb(t.base_color), "base_color", kind); },
      [&] { out.orm = encoded(t.orm, "occlusion_roughness_metalness", kind); },
      [&] {
        if (!t.specular.empty()) out.specular = exact(specular_picture(t.specular), "specular", kind);
      }};
  parallel_for(int(std::size(jobs)), [&](int i) { jobs[i](); });
  return out;
}

double index_of_refraction(const AssetPictures& pictures) {
  const double root = std::sqrt(double(dielectric_f0(pictures.middle_specular, 0.0f)));
  return (1 + root) / (1 - root);
}

Picture gray_picture(const Image& image, int channel, const std::string& name) {
  Image gray(image.width, image.height, 1);
  for (size_t i = 0; i < gray.data.size(); ++i) gray.data[i] = image.data[i * image.channels + channel];
  return encoded(gray, name, PictureKind::png);
}

}  // namespace cei3d

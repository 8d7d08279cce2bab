// SPDX-License-Identifier: Apache-2.0
// What light and material leave of the training photographs, as pictures. A hit is corrected by a blend of
// those that were taken from the nearest directions. [Buehler et al. 2001]
// docs/method.md#correction-by-photographs
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/json_reader.h"
#include "core/base/tensors.h"
#include "core/math/camera.h"
#include "model/geometry/shape/hit.h"

namespace cei3d {

// The part of a photograph that shows the object. A pixel is its radiance less that of the object there, and
// the distance of the surface that it shows; most of a byte's steps are near zero.
class ResidualImage {
 public:
  ResidualImage() = default;  // shows nothing
  // camera: of the whole photograph, unit frame. pixels: its columns and rows, on the object. differences:
  // #pixels, linear. distances: #pixels, from the camera's center along the ray, unit frame.
  ResidualImage(const Camera& camera, std::span<const std::array<uint16_t, 2>> pixels,
                std::span<const Vec3f> differences, std::span<const float> distances);
  // camera: of the window. bytes: [height, width, kBytes].
  ResidualImage(const Camera& camera, float range, std::vector<uint8_t> bytes);

  static constexpr size_t kBytes = 5;               // of a pixel: three channels, distance
  const Camera& camera() const { return camera_; }  // of the window
  float range() const { return range_; }            // the largest absolute difference that it holds
  const std::vector<uint8_t>& bytes() const { return bytes_; }

  // The difference at a point of the surface, interpolated between those of its four neighbors that show the
  // same surface. None: the picture does not show the point, or at a grazing angle.
  std::optional<Vec3f> at(Vec3f position, Vec3f normal) const;
  // An image whose interpolated values, averaged over a pixel as renders do, are those of this one's pixels.
  ResidualImage sharpened() const;
  // Of means over squares of the surface, whose side is `size` (unit frame) where it is as far away as the
  // middle of the object.
  ResidualImage smoothed(float size) const;

 private:
  // From the camera to the surface that a pixel shows; none: it shows nothing.
  std::optional<float> distance(int x, int y) const;
  std::optional<Vec3f> point_of(int x, int y) const;
  Vec3f difference(int x, int y) const;
  const uint8_t* pixel(int x, int y) const {
    return &bytes_[(size_t(y) * size_t(camera_.width) + size_t(x)) * kBytes];
  }

  Camera camera_;
  float range_ = 0, nearest_ = 0;
  std::vector<uint8_t> bytes_;
};

class ResidualImages {
 public:
  struct Blend {
    Vec3f difference;  // linear radiance
    float angle;       // radians between the hit's view direction and those of the pictures, weighted mean
  };
  // Angles (degrees) between which strengths are interpolated.
  static constexpr std::array<float, 7> kAngles = {0, 5, 10, 20, 30, 45, 60};
  using Strengths = std::array<float, kAngles.size()>;
  static size_t nearest_angle(float angle);  // index; angle: radians

  explicit ResidualImages(std::vector<ResidualImage> images);  // all strengths are 1

  const std::vector<ResidualImage>& images() const { return images_; }
  const Strengths& strengths() const { return strengths_; }
  void set_strengths(const Strengths& strengths) { strengths_ = strengths; }
  void sharpen();  // ResidualImage::sharpened() of all
  // without: index of a picture that is left out. None: no picture shows the point from within 60 degrees.
  std::optional<Blend> blend(const Hit&, int without = -1) const;
  float strength(float angle) const;  // share of a blend that is added; angle: radians
  Vec3f at(const Hit&) const;         // linear radiance to add
  // The same without the details of the surface: what is left of errors of light and material.
  Vec3f smooth_at(const Hit&) const;

 private:
  Vec3f weighed(const std::optional<Blend>&) const;

  std::vector<ResidualImage> images_, smooth_;
  Strengths strengths_;
};

// head["residual_images"] and tensors "residual_images/...".
void save_residual_images(const ResidualImages&, Tensors& tensors, Json& head);
ResidualImages load_residual_images(const Tensors& tensors, JsonReader head);

}  // namespace cei3d

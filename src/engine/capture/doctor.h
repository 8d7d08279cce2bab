// SPDX-License-Identifier: Apache-2.0
// The consistency checks of check(): sparse points against the cameras, masks against each other, photographs
// against their neighbors.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "engine/capture/check.h"
#include "engine/capture/mask_votes.h"
#include "engine/io/exif.h"
#include "model/scene/view.h"

namespace cei3d {

// "a, b, c", of more than five names the first five and the number of the others.
std::string some_names(const std::vector<std::string>& names);

// The repair that leaves out the views of these names.
std::function<void(Capture&)> removal_of(std::vector<std::string> names);

// Sparse points projected into the photographs that show them: names swapped or misplaced lens coefficients,
// principal points that are half a pixel off, K of another image size, views of another pose. Captures
// without points: nothing.
void check_tracks(const Capture& capture, std::vector<Finding>& findings);

// Intrinsics that no camera has: a focal length in millimeters, a principal point of another image size.
void check_intrinsics(const Capture& capture, std::vector<Finding>& findings);

// Background along the outline of a mask.
struct MaskBorder {
  int width = 0, height = 0;  // of the reduced mask
  double share = 0;           // of its object pixels
  Area loose;                 // [height][width]; empty: little
};
// rgba: load_linear_rgba() of the view; mask: of its size.
MaskBorder look_at_border(const View& view, const Image& rgba, std::span<const uint8_t> mask);

struct JudgedMask {
  const View* view = nullptr;
  std::span<const uint8_t> mask;       // of view->camera
  const Image* photograph = nullptr;   // PhotoLook::small of the view; null: none
  const MaskBorder* border = nullptr;  // null: not known
  bool moved = false;                  // a part of the object is in another place than in most views
};

// Views whose mask disagrees with the others. normalization: none if the masks have no volume in common;
// then, or when most disagree, the usual mistakes that concern all cameras are tried. A mask that leaves out
// what the others show is right where the photograph has the colors of the background there. Returns an area
// for each mask: where it is not believed; empty: nowhere.
std::vector<Area> check_silhouettes(std::span<const JudgedMask> masks,
                                    const std::optional<Normalization>& normalization,
                                    std::vector<Finding>& findings);

// A part that was moved between two photographs, which were taken in the order of their names. Returns one
// area for each mask: in the views before the move or in those after it, whichever are fewer, the pixels
// where the part may be in either position; in the others, and if nothing moved, an empty one.
std::vector<Area> check_moves(std::span<const JudgedMask> masks, const Normalization&,
                              std::vector<Finding>& findings);

// Masks that fill gaps of the object. Returns an area for each mask: the filled gaps; empty: none.
std::vector<Area> check_gaps(std::span<const JudgedMask> masks, const Normalization&,
                             std::vector<Finding>& findings);

// Masks that are drawn wider than the object. Returns an area for each mask: background along its outline;
// empty: none, or hardly more than in most masks.
std::vector<Area> check_borders(std::span<const JudgedMask> masks, std::vector<Finding>& findings);

// What is compared between photographs.
struct PhotoLook {
  bool seen = false;
  double brightness = 0;  // mean logarithm of the object's luminance
  double sharpness = 0;   // mean second difference of the object's luminance, relative to the luminance
  Image small;            // RGB, linear, by reduction_of() of its size
  std::vector<float> thumbnail;     // [kThumbnail][kThumbnail][3], linear
  std::vector<uint8_t> background;  // [kThumbnail][kThumbnail], 1: nothing of the object
  ExifNotes notes;                  // of the camera
};
inline constexpr int kThumbnail = 24;
// rgba: load_linear_rgba() of the view.
PhotoLook look_at_photo(const View& view, const Image& rgba);

struct JudgedPhoto {
  const View* view = nullptr;
  const PhotoLook* look = nullptr;
};
// Jumps of exposure, white balance left to the camera, blur, the same photograph twice, a background that
// does not move with the cameras. center: of the object, capture frame.
void check_photographs(std::span<const JudgedPhoto> photos, Vec3d center, std::vector<Finding>& findings);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Scores of one edit, accumulated view by view: against true images of the edit, and on the rest of the
// object.
#pragma once

#include "core/image/area.h"
#include "engine/render/render.h"
#include "engine/session/perceptual.h"
#include "engine/session/requests.h"

namespace cei3d {

// An image that a folder may hold for a view: FOLDER/<last part of its name>.png.
std::filesystem::path image_like(const std::filesystem::path& folder, const View& view);

// Images of one view: RGBA, sRGB, straight alpha.
struct EditImages {
  Image before, after;  // rendered without and with the edit
  Image photo;
};

struct EditedArea {
  Area any;   // pixels with at least one sample on surface that the layer changed
  Area half;  // pixels with at least half of their samples on it
};
// All pixels if the layer is not local. g: trace_view() of the scene with the layer.
EditedArea edited_area(const Scene&, const EditLayer&, const GBuffer& g, const EditImages&);

class EditScorer {
 public:
  // truth, masks: folders of true images and masks of the edit; empty: no truth, and the region of the edit
  // is used as mask.
  EditScorer(std::filesystem::path truth, std::filesystem::path masks, const Perceptual& perceptual)
      : truth_(std::move(truth)), masks_(std::move(masks)), perceptual_(perceptual) {}

  // own: edited_area(). Errors: images of another size than the view.
  void add(const View&, const EditImages&, const EditedArea& own);
  // Error: a truth folder was given, and no view has an image in it.
  EditScore result() const;

 private:
  void add_truth(const View&, const EditImages&, const Area& mask, const Area& own);
  void add_rest(const EditImages&, const Area& grown);

  std::filesystem::path truth_, masks_;
  const Perceptual& perceptual_;
  double squared_error_ = 0;
  size_t in_both_ = 0, in_either_ = 0;
  EditFidelity fidelity_;
  RestScore rest_;  // sums
  FeatureSet before_, after_;
};

}  // namespace cei3d

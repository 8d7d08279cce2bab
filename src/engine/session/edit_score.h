// SPDX-License-Identifier: Apache-2.0
// How well one edit did, gathered view by view: against pictures of how it should look, and on the rest of
// the object.
#pragma once

#include "core/image/area.h"
#include "engine/render/render.h"
#include "engine/session/perceptual.h"
#include "engine/session/requests.h"

namespace cei3d {

// A picture that a folder may hold for a view: FOLDER/<last part of its name>.png.
std::filesystem::path picture_like(const std::filesystem::path& folder, const View& view);

// Pictures of one view: RGBA, sRGB, straight alpha.
struct EditPictures {
  Image before, after;  // rendered without and with the edit
  Image photo;
};

struct EditedArea {
  Area any, most;  // pixels of whose samples one, at least half meet what the layer changed
};
// All pixels for a layer that is everywhere. g: the scene with the layer in it, traced.
EditedArea edited_area(const Scene&, const EditLayer&, const GBuffer& g, const EditPictures&);

class EditScorer {
 public:
  // truth, masks: folders; empty: there is no truth, and the edit is where its own region is.
  EditScorer(std::filesystem::path truth, std::filesystem::path masks, const Perceptual& perceptual)
      : truth_(std::move(truth)), masks_(std::move(masks)), perceptual_(perceptual) {}

  // own: edited_area(). Errors: pictures of another size than the view.
  void add(const View&, const EditPictures&, const EditedArea& own);
  // Error: truth was asked for, and no view has any.
  EditScore result() const;

 private:
  void add_truth(const View&, const EditPictures&, const Area& mask, const Area& own);
  void add_rest(const EditPictures&, const Area& grown);

  std::filesystem::path truth_, masks_;
  const Perceptual& perceptual_;
  double squared_error_ = 0;
  size_t in_both_ = 0, in_either_ = 0;
  EditFidelity fidelity_;
  RestScore rest_;  // sums
  FeatureSet before_, after_;
};

}  // namespace cei3d

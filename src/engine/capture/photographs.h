// SPDX-License-Identifier: Apache-2.0
// The last step of every loader: from what the camera files say to views that fit the files on disk.
#pragma once

#include "model/scene/view.h"

namespace cei3d {

// Drops views whose image is missing, as long as half of them are there (strict: drops none; check() reports
// them). Scales cameras to images of another size and the same proportions. Finds masks that the cameras do
// not name, and decides from their content whether dark or bright means the object. Gives views with a lens
// their pinhole camera. Says in capture.warnings what it assumed.
void fit_to_photographs(Capture& capture, bool strict);

}  // namespace cei3d

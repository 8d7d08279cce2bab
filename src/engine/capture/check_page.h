// SPDX-License-Identifier: Apache-2.0
// The answer of check() as pictures and as one HTML page.
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/capture/check.h"

namespace cei3d {

// One view, `size` pixels wide and high at most, sRGB RGB: the photograph, what is not the object darkened,
// pixels where its mask is overruled red. A view that cannot be read is gray.
Image view_picture(const View& view, const CaptureReport& report, int size);

// All views in rows, in the capture's order; those of a warning or problem have a red frame.
// Where the border of the photograph cuts the object, that is seen without one.
Image contact_sheet(const Capture& capture, const CaptureReport& report, int size = 160);

// A page that needs no other file: findings with their fixes, cameras and sphere, all views with their names.
std::string check_page(const Capture& capture, const CaptureReport& report);

}  // namespace cei3d

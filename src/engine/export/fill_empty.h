// SPDX-License-Identifier: Apache-2.0
// Colors for the texels of a texture that no chart covers.
#pragma once

#include "core/image/area.h"

namespace cei3d {

// Gives the texels outside of `known` the mean of the known ones near them, so that filtering across the
// border of a chart, and mip levels, mix with nothing else. By means of 2 x 2 texels, of these, and so on.
void fill_empty(Image& image, const Area& known);

}  // namespace cei3d

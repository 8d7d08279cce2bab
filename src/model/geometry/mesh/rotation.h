// SPDX-License-Identifier: Apache-2.0
// The rotation part of a matrix.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// The rotation R nearest to m, which maximizes trace(R^T m). Never a reflection; the identity for m = 0. By
// the largest eigenvector of a symmetric 4x4 matrix of quaternions. [Horn 1987]
Mat3d nearest_rotation(const Mat3d& m);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "core/math/tangents.h"

#include <gtest/gtest.h>

#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

TEST(Tangents, AreRightHandedFramesWhateverTheAxis) {
  for (int first = 0; first < 3; ++first)
    for (int i = 0; i < 200; ++i) {
      const Vec3f z =
          i < 3 ? Vec3f{float(i == 0), float(i == 1), float(i == 2)} : fibonacci_direction(i, 200);
      const Tangents<float> t = tangents_of(z, first);
      const Mat3f frame{{t.x, t.y, z}};
      const Mat3f product = frame * transpose(frame);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(product.row[r][c], r == c, 1e-5f);
      EXPECT_NEAR(determinant(frame), 1, 1e-5f);
    }
}

}  // namespace
}  // namespace cei3d

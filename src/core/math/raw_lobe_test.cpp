// SPDX-License-Identifier: Apache-2.0
#include "core/math/raw_lobe.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"

namespace cei3d {
namespace {

template <class T>
T& member(LobeNumbers<T>& l, int i) {
  return i < 3 ? l.axis[i] : i == 3 ? l.lambda : l.color[i - 4];
}

TEST(RawLobe, GradientEqualsDualNumbers) {
  using D = Dual<double>;
  LobeNumbers<double> raw{{0.4, -1.1, 0.7}, 1.3, {0.5, -0.2, 1.4}},
      d_lobe{{0.3, 0.9, -0.5}, 0.2, {1.1, -0.7, 0.6}};
  LobeNumbers<double> grad = lobe_of_raw_grad(raw, d_lobe);
  for (int i = 0; i < 7; ++i) {
    LobeNumbers<D> varied;
    for (int j = 0; j < 7; ++j) member(varied, j) = D(member(raw, j), i == j ? 1.0 : 0.0);
    LobeNumbers<D> lobe = lobe_of_raw(varied);
    double want = 0;
    for (int j = 0; j < 7; ++j) want += member(d_lobe, j) * member(lobe, j).derivative;
    EXPECT_NEAR(member(grad, i), want, 1e-12) << i;
    EXPECT_GT(std::abs(want), 1e-3);
  }
}

}  // namespace
}  // namespace cei3d

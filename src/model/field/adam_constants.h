// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// Of Adam: decay of the mean squared gradient, and what is added to its root. A short mean follows a loss
// whose scale changes while it is trained; PyTorch's defaults are 0.999 and 1e-8.
struct AdamConstants {
  float beta2 = 0.99f, eps = 1e-15f;
};

}  // namespace cei3d

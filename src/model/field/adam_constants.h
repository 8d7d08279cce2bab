// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// Constants of Adam: the decay of the mean squared gradient, and the number that is added to its root. A
// short mean follows a loss whose scale changes during training; PyTorch's defaults are 0.999 and 1e-8.
struct AdamConstants {
  float beta2 = 0.99f, eps = 1e-15f;
};

}  // namespace cei3d

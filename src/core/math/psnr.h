// SPDX-License-Identifier: Apache-2.0
// Errors in decibels.
#pragma once

#include <cmath>

namespace cei3d {

// Peak signal-to-noise ratio in dB from a mean squared error; the peak is 1. Infinity for equal values.
inline double psnr_of_mse(double mse) { return -10 * std::log10(mse); }

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The kernels on an NVIDIA card: one thread an item, all launches one after another, each finished when it
// returns.
//
// Arrays belong to the caller, and the card must be able to reach them: cudaMalloc, or host memory of
// cudaHostAlloc. Addresses are the same on both sides; nothing is copied. That holds for tables, too:
// split_sum_table() is an ordinary array of the host, of which the caller makes a copy. Arrays are aligned to
// 16 bytes. Only items below n are read and written; padding is left alone.
//
// Sums that several items add to (EncodeGridGrad, weight gradients) are in an order that changes from run to
// run, and so do their last bits. Numbers below 1e-38 count as zero, as they do on the CPU.
#pragma once

#include <string>

#include "core/compute/device.h"

namespace cei3d::cuda {

// The card that CUDA takes by default. Errors of a launch name the kernel and what CUDA says.
extern const LaunchTable table;

// Why there is no card to run on, in CUDA's words; empty where there is one.
std::string reason_for_no_card();

// What a report of measurements says about the card.
struct Card {
  std::string name, driver;  // driver: its version, "580.159.04"; "unknown" where the system does not tell
  int processors, cuda;      // multiprocessors; version of CUDA's runtime, 13000 for 13.0
  int capability;            // 90 for 9.0
};
Card card();

}  // namespace cei3d::cuda

// SPDX-License-Identifier: Apache-2.0
// The tests of the kernels with the card among the devices.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "core/compute/cuda/device.h"
#include "core/compute/cuda/test_heap.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (const std::string reason = cei3d::cuda::reason_for_no_card(); !reason.empty()) {
    std::printf("SKIP: the kernels on a card: compiled, not run (%s)\n", reason.c_str());
    return 77;
  }
  const cei3d::cuda::Card card = cei3d::cuda::card();
  std::printf("%s, %d multiprocessors, capability %d, driver %s, CUDA %d\n", card.name.c_str(),
              card.processors, card.capability, card.driver.c_str(), card.cuda);
  cei3d::cuda::open_heap();
  for (const cei3d::Device& d : cei3d::all_devices()) std::printf("device %s\n", d.name().c_str());
  const int status = RUN_ALL_TESTS();
  // Without destructors: CUDA may take the heap back before the last of them runs.
  std::fflush(nullptr);
  std::_Exit(status);
}

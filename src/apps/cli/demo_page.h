// SPDX-License-Identifier: Apache-2.0
// The page that shows all pictures of `cei3d demo`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cei3d {

// A file of the finished object.
struct DemoFile {
  std::string name, what;
  uintmax_t bytes = 0;
};

// HTML with relative links. views: held-out views; turntable: names of the pictures without ".png".
std::string demo_page(const std::vector<std::string>& views, const std::vector<std::string>& turntable,
                      const std::vector<DemoFile>& files);

}  // namespace cei3d

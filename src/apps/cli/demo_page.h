// SPDX-License-Identifier: Apache-2.0
// The page that shows all pictures of `cei3d demo`.
#pragma once

#include <string>
#include <vector>

namespace cei3d {

// HTML with relative links. views: held-out views; turntable: names of the pictures without ".png".
std::string demo_page(const std::vector<std::string>& views, const std::vector<std::string>& turntable);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The sample capture that comes with the program.
#pragma once

#include <filesystem>

namespace cei3d {

// The sample capture: PREFIX/share/cei3d/samples/spot for a program in PREFIX/bin, samples/spot of the source
// tree for one that was built there. program: its file. Error: neither is there.
std::filesystem::path demo_sample(const std::filesystem::path& program);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// The sample capture that comes with the program.
#pragma once

#include <filesystem>

namespace cei3d {

// Of a program in PREFIX/bin: PREFIX/share/cei3d/samples/spot; of one that was built in the source tree:
// samples/spot there. program: its file. Error: neither is there.
std::filesystem::path demo_sample(const std::filesystem::path& program);

}  // namespace cei3d

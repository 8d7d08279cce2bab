// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/cli/command.h"
#include "engine/session/bench.h"

namespace cei3d {
namespace {

struct Options {};

void bench(const Options&, Session& session, Console& console) {
  Json json = Json::array();
  std::string text = fmt::format("{} on one core, best of 7 runs\n", session.device().name());
  for (const BenchRow& r : bench_kernels(session.device())) {
    json.push_back({{"name", r.name}, {"rate", r.rate}, {"unit", r.unit}, {"of_peak", r.of_peak}});
    text += fmt::format("{:45} {:9.1f} {:13} {:4.0f} %\n", r.name, r.rate, r.unit, 100 * r.of_peak);
  }
  console.answer(json, text);
}

}  // namespace

void add_bench(Commands& commands) {
  auto o = std::make_shared<Options>();
  commands.on(commands.add("bench", "Speed of the kernels as a fraction of this machine's measured peak"), o,
              bench);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "engine/bench/bench.h"

namespace cei3d {
namespace {

struct Options {
  std::string capture, time = "6s";
  BenchRequest request;
};

void bench(const Options& o, Session& session, Console& console) {
  BenchRequest request = o.request;
  if (!o.capture.empty()) request.capture = parse_capture_spec(o.capture).path;
  request.seconds = parse_duration(o.time);
  const BenchReport r = run_bench(session, request, console);
  console.answer(r.json(), r.text());
}

}  // namespace

void add_bench(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("bench",
                                "Measure the speed of kernels (as fractions of this machine's peak), of "
                                "training, of a frame and an edit");
  verb->add_option("--capture", o->capture,
                   "Capture to train on (default: samples/spot, else a synthetic ball)");
  verb->add_option("--project", o->request.project,
                   "Project to measure a 512 x 512 frame and a paint edit on; it is not changed (default: "
                   "neither is measured)");
  verb->add_option("--time", o->time, "Duration of the training measurement: seconds, or 90s, 10m")
      ->capture_default_str();
  verb->add_option("--repeats", o->request.repeats,
                   "Repetitions of every kernel; frames and edits are repeated a third as often")
      ->check(CLI::Range(3, 1000))
      ->capture_default_str();
  verb->add_option("--only", o->request.only,
                   "What to measure: kernels, fields, training, object (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember({"kernels", "fields", "training", "object"}));
  commands.on(verb, o, bench);
}

}  // namespace cei3d

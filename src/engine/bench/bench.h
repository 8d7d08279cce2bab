// SPDX-License-Identifier: Apache-2.0
// Speed measurements: kernels as fractions of the measured peaks of the machine, a training step by its
// parts, a frame, an edit. Every figure has its spread, so that bench/compare can tell a change from noise.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/json.h"
#include "core/base/progress.h"
#include "engine/session/requests.h"

namespace cei3d {

class Device;
class Session;

// Statistics of repeated measurements of one quantity.
struct Spread {
  double median = 0;
  double deviation = 0;  // median absolute deviation from the median
  double best = 0;       // the least disturbed measurement: maximum of rates, minimum of times
  int repeats = 0;
};
// values: at least one. Error otherwise.
Spread spread_of(std::vector<double> values, bool higher_is_better);

struct BenchFigure {
  std::string group;  // "machine", "kernels", "fields", "training", "object"
  // Capture or project that it was measured on; figures of different ones do not compare.
  std::string subject;
  std::string name, unit;
  bool higher_is_better = true;
  Spread spread;
  std::vector<std::pair<std::string, double>> of;  // name of a peak, best as a fraction of the peak's best
};

struct BenchRequest {
  std::filesystem::path capture;  // empty: samples/spot below the working folder, or else a synthetic ball
  std::filesystem::path project;  // empty: no frame and no edit
  double seconds = 6;             // of training steps
  int repeats = 21;  // repetitions of kernels; steps of fields, frames and edits take a third of them
  std::vector<std::string> only;  // "kernels", "fields", "training", "object"; empty: all
};
struct BenchReport {
  MachineInfo machine;
  std::string device;
  std::vector<BenchFigure> figures;
  Json json() const;
  std::string text() const;
};

// Errors: capture or project cannot be read; cancelled.
BenchReport run_bench(Session&, const BenchRequest&, Progress&);

// The parts of run_bench(). Kernels and peaks: one core. Fields, training and object: all threads.
std::vector<BenchFigure> bench_kernels(const Device&, int repeats);
std::vector<BenchFigure> bench_fields(const Device&, int repeats, Progress&);
struct TrainingBench {
  std::filesystem::path capture;  // as in BenchRequest
  double seconds = 6;
  // Steps before the measurement, from the start of the schedule to its middle, after at most twice as many
  // prefit steps.
  int warm_up = 150;
  int block = 25;  // steps per measurement, as many as between two updates of the occupancy grid
  int min_measurements = 7;
};
std::vector<BenchFigure> bench_training(const Device&, const TrainingBench&, Progress&);
// A 512 x 512 frame of the project's first held-out view, and later ones in the same session; two paint
// edits, made on copies that the session opens.
std::vector<BenchFigure> bench_object(Session&, const std::filesystem::path& project, int repeats, Progress&);

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// How fast this machine is, and how much of it the program uses: kernels as fractions of measured peaks, a
// training step by its parts, a frame, an edit. Every figure carries its spread, so that bench/compare can
// tell a change from noise.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/base/progress.h"
#include "engine/session/requests.h"

namespace cei3d {

class Device;
class Session;

// Of repeated measurements of one quantity.
struct Spread {
  double median = 0;
  double deviation = 0;  // median absolute deviation from the median
  double best = 0;       // least disturbed by others: the greatest of rates, the least of times
  int repeats = 0;
};
// values: at least one. Error otherwise.
Spread spread_of(std::vector<double> values, bool higher_is_better);

struct BenchFigure {
  std::string group;    // "machine", "kernels", "training", "object"
  std::string subject;  // what it was measured on, where that is not the machine itself: only figures of one
                        // subject can be compared
  std::string name, unit;
  bool higher_is_better = true;
  Spread spread;
  std::vector<std::pair<std::string, double>> of;  // name of a peak, best as a fraction of the peak's best
};

struct BenchRequest {
  std::filesystem::path capture;  // empty: samples/spot below the working folder, else a ball that is made up
  std::filesystem::path project;  // empty: no frame and no edit
  double seconds = 6;             // of training steps
  int repeats = 21;               // of kernels; frames and edits take a third of them
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

// Its parts. Kernels and peaks: one core. Training and object: all threads.
std::vector<BenchFigure> bench_kernels(const Device&, int repeats);
struct TrainingBench {
  std::filesystem::path capture;  // as in BenchRequest
  double seconds = 6;
  int warm_up = 150;  // steps before, from the start of the schedule to its middle, after at most twice as
                      // many of prefit
  int block = 25;     // steps a measurement: as many as between two looks at the occupancy grid
  int least = 7;      // measurements, however long they take
};
std::vector<BenchFigure> bench_training(const Device&, const TrainingBench&, Progress&);
// A 512 x 512 frame of the project's first held-out view, and later ones in the same session; two paint
// edits, made on copies that the session opens.
std::vector<BenchFigure> bench_object(Session&, const std::filesystem::path& project, int repeats, Progress&);

}  // namespace cei3d

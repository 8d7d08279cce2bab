// SPDX-License-Identifier: Apache-2.0
// Measures work on the card beside the same work on the CPU, and prints the figures.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/aligned.h"
#include "core/compute/device.h"

namespace cei3d::cuda {

// An array of the host and its copy on the card.
class Twin {
 public:
  Twin(size_t n, const std::function<float(size_t)>& value);
  explicit Twin(size_t n, float value = 0);
  ~Twin();
  Twin(const Twin&) = delete;
  Twin& operator=(const Twin&) = delete;

  float* on_cpu() { return host_.data(); }
  float* on_card() { return card_; }
  void fill(float value);  // both
  // The largest difference between the two, as a share of the largest number of the CPU's.
  double difference() const;

 private:
  void upload();
  AlignedVector<float> host_;
  float* card_ = nullptr;
};

struct Work {
  std::string name;
  std::string unit;
  double amount;                  // of the unit
  std::function<void()> on_card;  // puts it in line
  std::function<void()> on_cpu;   // on all threads; or none
  Twin* result = nullptr;         // of both, compared after one run
  std::string peak = {};          // the name of an earlier figure
  double peak_amount = 0;         // what the work needs of the peak's unit
};

struct Figure {
  std::string name, unit;
  double card_ms, cpu_ms;  // medians; cpu_ms 0: not measured
  double rate;             // of the card, in units per second
  std::string peak;
  double share;       // of the peak
  double difference;  // between card and CPU; -1: not compared
};

class Report {
 public:
  explicit Report(const Device& cpu) : cpu_(cpu) {}
  const Device& cpu() const { return cpu_; }
  void measure(const Work&);
  // Whether card and CPU have come to the same numbers, up to the order of long sums.
  bool agrees() const;
  void print() const;  // a table, then the same as one line of JSON

 private:
  void print_json() const;
  const Device& cpu_;
  std::vector<Figure> figures_;
};

}  // namespace cei3d::cuda

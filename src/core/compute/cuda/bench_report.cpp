// SPDX-License-Identifier: Apache-2.0
#include "core/compute/cuda/bench_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "core/base/clock.h"
#include "core/base/parallel.h"
#include "core/compute/cuda/check.h"
#include "core/compute/cuda/device.h"

namespace cei3d::cuda {

Twin::Twin(size_t n, const std::function<float(size_t)>& value) : host_(n) {
  parallel_ranges(int((n + 4095) / 4096), 16, [&](int begin, int end) {
    for (size_t i = size_t(begin) * 4096; i < std::min(n, size_t(end) * 4096); ++i) host_[i] = value(i);
  });
  check(cudaMalloc(&card_, n * sizeof(float)), "memory of the card");
  upload();
}
Twin::Twin(size_t n, float value) : Twin(n, [value](size_t) { return value; }) {}
Twin::~Twin() { cudaFree(card_); }

void Twin::upload() {
  check(cudaMemcpy(card_, host_.data(), host_.size() * sizeof(float), cudaMemcpyHostToDevice), "upload");
}

void Twin::fill(float value) {
  std::fill(host_.begin(), host_.end(), value);
  upload();
}

double Twin::difference() const {
  AlignedVector<float> copy(host_.size());
  check(cudaMemcpy(copy.data(), card_, copy.size() * sizeof(float), cudaMemcpyDeviceToHost), "download");
  double largest = 1e-30, worst = 0;
  for (size_t i = 0; i < copy.size(); ++i) {
    const double d = std::abs(double(copy[i]) - host_[i]);
    if (!std::isfinite(d)) return INFINITY;
    worst = std::max(worst, d);
    largest = std::max(largest, double(std::abs(host_[i])));
  }
  return worst / largest;
}

namespace {

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

class Event {
 public:
  Event() { check(cudaEventCreate(&event_), "event"); }
  ~Event() { cudaEventDestroy(event_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  void record() { check(cudaEventRecord(event_), "event"); }
  double ms_since(const Event& begin) const {
    float ms = 0;
    check(cudaEventSynchronize(event_), "measured work");
    check(cudaEventElapsedTime(&ms, begin.event_, event_), "event");
    return ms;
  }

 private:
  cudaEvent_t event_;
};

double card_ms(const Work& work) {
  constexpr int kWarmUps = 3, kRepeats = 15;
  std::vector<double> ms;
  Event begin, end;
  for (int k = 0; k < kWarmUps + kRepeats; ++k) {
    begin.record();
    work.on_card();
    end.record();
    const double elapsed = end.ms_since(begin);
    if (k >= kWarmUps) ms.push_back(elapsed);
  }
  return median(std::move(ms));
}

double cpu_ms(const Work& work) {
  std::vector<double> ms;
  for (int k = 0; k < 4; ++k) {
    const double begin = steady_seconds();
    work.on_cpu();
    if (k > 0) ms.push_back(1e3 * (steady_seconds() - begin));
  }
  return median(std::move(ms));
}

double difference_after_one_run(const Work& work) {
  work.result->fill(0);
  work.on_card();
  check(cudaDeviceSynchronize(), work.name.c_str());
  work.on_cpu();
  return work.result->difference();
}

}  // namespace

void Report::measure(const Work& work) {
  Figure f{work.name, work.unit, 0, 0, 0, work.peak, 0, -1};
  if (work.result && work.on_cpu) f.difference = difference_after_one_run(work);
  f.card_ms = card_ms(work);
  if (work.on_cpu) f.cpu_ms = cpu_ms(work);
  f.rate = work.amount / (1e-3 * f.card_ms);
  for (const Figure& peak : figures_)
    if (peak.name == work.peak) f.share = work.peak_amount / (1e-3 * f.card_ms) / peak.rate;
  figures_.push_back(f);
  std::fprintf(stderr, "measured: %s\n", f.name.c_str());
}

bool Report::agrees() const {
  return std::all_of(figures_.begin(), figures_.end(), [](const Figure& f) { return f.difference < 1e-3; });
}

void Report::print() const {
  const Card c = card();
  std::printf("%s, %d multiprocessors, driver %s, CUDA %d, beside %s on %u threads\n\n", c.name.c_str(),
              c.processors, c.driver.c_str(), c.cuda, cpu_.name().c_str(),
              std::thread::hardware_concurrency());
  std::printf("%-44s %9s %9s %7s %20s %6s  %-30s %s\n", "", "card ms", "CPU ms", "ratio", "rate of the card",
              "share", "of", "difference");
  for (const Figure& f : figures_) {
    std::printf("%-44s %9.3f ", f.name.c_str(), f.card_ms);
    f.cpu_ms > 0 ? std::printf("%9.2f %7.1f ", f.cpu_ms, f.cpu_ms / f.card_ms) : std::printf("%18s", "");
    std::printf("%9.2f %-10s ", f.rate, f.unit.c_str());
    f.share > 0 ? std::printf("%5.1f%%  %-30s ", 100 * f.share, f.peak.c_str()) : std::printf("%38s ", "");
    f.difference >= 0 ? std::printf("%.1e\n", f.difference) : std::printf("\n");
  }
  std::printf("\n");
  print_json();
}

// Names are plain words without quotes.
void Report::print_json() const {
  const Card c = card();
  std::printf(R"({"card":"%s","driver":"%s","cuda":%d,"cpu":"%s","threads":%u,"figures":[)", c.name.c_str(),
              c.driver.c_str(), c.cuda, cpu_.name().c_str(), std::thread::hardware_concurrency());
  for (const Figure& f : figures_) {
    const char* comma = &f == &figures_.front() ? "" : ",";
    std::printf(R"(%s{"name":"%s","card_ms":%.5g,"cpu_ms":%.5g,"rate":%.5g,"unit":"%s")", comma,
                f.name.c_str(), f.card_ms, f.cpu_ms, f.rate, f.unit.c_str());
    if (f.share > 0) std::printf(R"(,"share":%.4g,"of":"%s")", f.share, f.peak.c_str());
    if (f.difference >= 0) std::printf(R"(,"difference":%.3g)", std::min(f.difference, 1e30));
    std::printf("}");
  }
  std::printf("]}\n");
}

}  // namespace cei3d::cuda

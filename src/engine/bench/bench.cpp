// SPDX-License-Identifier: Apache-2.0
#include "engine/bench/bench.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

double middle(std::vector<double>& v) {
  const auto half = v.begin() + std::ptrdiff_t(v.size() / 2);
  std::nth_element(v.begin(), half, v.end());
  if (v.size() % 2) return *half;
  return 0.5 * (*half + *std::max_element(v.begin(), half));
}

Json figure_json(const BenchFigure& f) {
  Json of = Json::object();
  for (const auto& [peak, fraction] : f.of) of[peak] = fraction;
  return {{"group", f.group},
          {"subject", f.subject},
          {"name", f.name},
          {"unit", f.unit},
          {"better", f.higher_is_better ? "higher" : "lower"},
          {"median", f.spread.median},
          {"deviation", f.spread.deviation},
          {"best", f.spread.best},
          {"repeats", f.spread.repeats},
          {"of", std::move(of)}};
}

void append(std::vector<BenchFigure>& to, std::vector<BenchFigure> figures) {
  std::move(figures.begin(), figures.end(), std::back_inserter(to));
}

}  // namespace

Spread spread_of(std::vector<double> values, bool higher_is_better) {
  if (values.empty()) fail("A figure without measurements (an error in the program).");
  Spread s;
  s.repeats = int(values.size());
  const auto [smallest, greatest] = std::minmax_element(values.begin(), values.end());
  s.best = higher_is_better ? *greatest : *smallest;
  s.median = middle(values);
  for (double& v : values) v = std::abs(v - s.median);
  s.deviation = middle(values);
  return s;
}

Json BenchReport::json() const {
  Json list = Json::array();
  for (const BenchFigure& f : figures) list.push_back(figure_json(f));
  return {{"machine", machine.json()}, {"device", device}, {"figures", std::move(list)}};
}

std::string BenchReport::text() const {
  std::string text = fmt::format("{}, {} on {} cores; medians and median absolute deviations\n",
                                 machine.processor, device, machine.cores);
  std::string group, subject;
  for (const BenchFigure& f : figures) {
    if (f.group != group || f.subject != subject)
      text += fmt::format("\n{}{}\n", f.group, f.subject.empty() ? "" : ", " + f.subject);
    group = f.group;
    subject = f.subject;
    text += fmt::format("  {:44} {:10.4g} +- {:<8.2g} {:12}", f.name, f.spread.median, f.spread.deviation,
                        f.unit);
    for (const auto& [peak, fraction] : f.of) text += fmt::format(" {:3.0f} % of {}", 100 * fraction, peak);
    text += '\n';
  }
  return text;
}

namespace {

bool asked(const BenchRequest& request, const char* part) {
  return request.only.empty() || std::ranges::count(request.only, part) > 0;
}

BenchReport measure(Session& session, const BenchRequest& request, Progress& progress) {
  const Device& device = session.device();
  BenchReport report;
  report.machine = Session::machine();
  report.device = device.name();
  const int fewer = (request.repeats + 2) / 3;
  progress.report({"kernels", 0, -1, ""});
  if (asked(request, "kernels")) append(report.figures, bench_kernels(device, request.repeats));
  if (asked(request, "fields")) append(report.figures, bench_fields(device, fewer, progress));
  if (asked(request, "training"))
    append(report.figures, bench_training(device, {request.capture, request.seconds}, progress));
  if (asked(request, "object") && !request.project.empty())
    append(report.figures, bench_object(session, request.project, fewer, progress));
  return report;
}

}  // namespace

BenchReport run_bench(Session& session, const BenchRequest& request, Progress& progress) {
  return session.threads().run([&] { return measure(session, request, progress); });
}

}  // namespace cei3d

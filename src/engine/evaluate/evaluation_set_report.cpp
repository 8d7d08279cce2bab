// SPDX-License-Identifier: Apache-2.0
// The tables of several captures.
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/evaluate/evaluation_set.h"
#include "engine/session/version.h"

namespace cei3d {
namespace {

// A score of a row; none: it has none.
struct Score {
  const char* name;
  const char* key;
  int digits;
  std::optional<double> (*of)(const EvaluationRow&);
};

std::optional<double> finite(double v) { return std::isfinite(v) ? std::optional(v) : std::nullopt; }

const RestScore* rest(const EvaluationRow& r) {
  return r.scores.edit && r.scores.edit->rest ? &*r.scores.edit->rest : nullptr;
}
const EditFidelity* truth(const EvaluationRow& r) {
  return r.scores.edit && r.scores.edit->truth ? &*r.scores.edit->truth : nullptr;
}
std::optional<double> none_or(const std::optional<double>* v) { return v ? *v : std::nullopt; }

const std::vector<Score> kViews{
    {"PSNR on white", "psnr", 2, [](const EvaluationRow& r) { return finite(r.scores.psnr); }},
    {"PSNR in the mask", "psnr_masked", 2,
     [](const EvaluationRow& r) { return finite(r.scores.psnr_masked); }},
    {"SSIM", "ssim", 4, [](const EvaluationRow& r) { return finite(r.scores.ssim); }},
    {"FLIP", "flip", 4, [](const EvaluationRow& r) { return r.scores.flip; }},
    {"LPIPS", "lpips", 4, [](const EvaluationRow& r) { return r.scores.lpips; }},
    {"FID", "fid", 1, [](const EvaluationRow& r) { return r.scores.fid; }},
    {"light and material alone: PSNR on white", "alone_psnr", 2,
     [](const EvaluationRow& r) { return finite(r.scores.alone ? r.scores.alone->psnr : r.scores.psnr); }},
    {"in the mask", "alone_psnr_masked", 2,
     [](const EvaluationRow& r) {
       return finite(r.scores.alone ? r.scores.alone->psnr_masked : r.scores.psnr_masked);
     }},
    {"made in, s", "seconds", 0,
     [](const EvaluationRow& r) { return r.seconds > 0 ? std::optional(r.seconds) : std::nullopt; }}};

const std::vector<Score> kEdit{
    {"non-edited area: PSNR", "rest_psnr", 2,
     [](const EvaluationRow& r) { return rest(r) ? finite(rest(r)->psnr) : std::nullopt; }},
    {"SSIM", "rest_ssim", 4,
     [](const EvaluationRow& r) { return rest(r) ? finite(rest(r)->ssim) : std::nullopt; }},
    {"FLIP", "rest_flip", 4,
     [](const EvaluationRow& r) { return none_or(rest(r) ? &rest(r)->flip : nullptr); }},
    {"LPIPS", "rest_lpips", 4,
     [](const EvaluationRow& r) { return none_or(rest(r) ? &rest(r)->lpips : nullptr); }},
    {"FID before/after", "fid_before_after", 1,
     [](const EvaluationRow& r) { return r.scores.edit ? r.scores.edit->fid : std::nullopt; }},
    {"PSNR inside the edit", "psnr_inside", 2,
     [](const EvaluationRow& r) { return truth(r) ? finite(truth(r)->psnr_inside) : std::nullopt; }},
    {"IoU", "iou", 3, [](const EvaluationRow& r) { return truth(r) ? finite(truth(r)->iou) : std::nullopt; }},
    {"edit, s", "seconds", 2, [](const EvaluationRow& r) { return finite(r.seconds); }}};

// Mean and, of two and more values, standard deviation.
struct Spread {
  double mean = 0, deviation = 0;
  size_t n = 0;
};

Spread spread_of(const std::vector<double>& values) {
  Spread s;
  s.n = values.size();
  for (const double v : values) s.mean += v / double(s.n);
  for (const double v : values) s.deviation += (v - s.mean) * (v - s.mean);
  s.deviation = s.n > 1 ? std::sqrt(s.deviation / double(s.n - 1)) : 0;
  return s;
}

using RowOf = const EvaluationRow* (*)(const EvaluationReport&);
const EvaluationRow* object_of(const EvaluationReport& r) { return &r.object; }
const EvaluationRow* paint_of(const EvaluationReport& r) {
  return r.paint.empty() ? nullptr : &r.paint.front();
}
const EvaluationRow* part_of(const EvaluationReport& r) { return r.part.empty() ? nullptr : &r.part.front(); }

// Mean and spread of a score over a capture's seeds.
Spread score_of(const EvaluatedCapture& c, RowOf row_of, const Score& score) {
  std::vector<double> values;
  for (const EvaluationReport& r : c.reports)
    if (const EvaluationRow* row = row_of(r))
      if (const auto v = score.of(*row)) values.push_back(*v);
  return spread_of(values);
}

// Mean and spread of a score over the captures' means.
Spread mean_of(const std::vector<EvaluatedCapture>& captures, RowOf row_of, const Score& score) {
  std::vector<double> values;
  for (const EvaluatedCapture& c : captures)
    if (const Spread s = score_of(c, row_of, score); s.n > 0) values.push_back(s.mean);
  return spread_of(values);
}

std::string cell(const Spread& s, int digits, bool with_deviation) {
  if (s.n == 0) return "-";
  if (!with_deviation || s.n == 1) return fmt::format("{:.{}f}", s.mean, digits);
  return fmt::format("{:.{}f} ± {:.{}f}", s.mean, digits, s.deviation, digits);
}

std::string table(const std::string& title, const std::vector<EvaluatedCapture>& captures, RowOf row_of,
                  const std::vector<Score>& scores) {
  std::vector<const Score*> used;
  for (const Score& s : scores)
    if (mean_of(captures, row_of, s).n > 0) used.push_back(&s);
  if (used.empty()) return "";
  std::string head = "| capture |", rule = "|---|", body;
  for (const Score* s : used) head += fmt::format(" {} |", s->name), rule += "---|";
  for (const EvaluatedCapture& c : captures) {
    if (!c.failed.empty()) continue;
    body += fmt::format("| [{0}]({0}/) |", c.name);
    for (const Score* s : used) body += fmt::format(" {} |", cell(score_of(c, row_of, *s), s->digits, true));
    body += "\n";
  }
  body += "| **mean** |";
  for (const Score* s : used)
    body += fmt::format(" {} |", cell(mean_of(captures, row_of, *s), s->digits, false));
  return fmt::format("\n## {}\n\n{}\n{}\n{}\n", title, head, rule, body);
}

Json means_json(const std::vector<EvaluatedCapture>& captures, RowOf row_of,
                const std::vector<Score>& scores) {
  Json j = Json::object();
  for (const Score& s : scores)
    if (const Spread m = mean_of(captures, row_of, s); m.n > 0) j[s.key] = m.mean;
  return j;
}

}  // namespace

Json EvaluationSetReport::json() const {
  Json list = Json::array();
  for (const EvaluatedCapture& c : captures) {
    Json j = {{"name", c.name}};
    if (!c.failed.empty()) j["failed"] = c.failed;
    j["reports"] = Json::array();
    for (const EvaluationReport& r : c.reports) j["reports"].push_back(r.json());
    list.push_back(std::move(j));
  }
  return {{"program", std::string("cei3d ") + kVersion},
          {"means",
           {{"views", means_json(captures, object_of, kViews)},
            {"paint", means_json(captures, paint_of, kEdit)},
            {"part", means_json(captures, part_of, kEdit)}}},
          {"captures", list}};
}

std::string EvaluationSetReport::markdown() const {
  std::string text = fmt::format(
      "# Evaluation of {} captures\n\nBy cei3d {}. docs/evaluation.md defines the scores; ± is the standard "
      "deviation over seeds. Each capture has a report of its own.\n",
      captures.size(), kVersion);
  text += table("Novel views", captures, object_of, kViews);
  text += table("A painted edit", captures, paint_of, kEdit);
  text += table("A part by clicks", captures, part_of, kEdit);
  for (const EvaluatedCapture& c : captures)
    if (!c.failed.empty()) text += fmt::format("\n{} could not be evaluated: {}\n", c.name, c.failed);
  return text;
}

}  // namespace cei3d

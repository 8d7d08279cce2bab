// SPDX-License-Identifier: Apache-2.0
// The tables of several captures.
#include <algorithm>
#include <cmath>
#include <functional>

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

using RowOf = std::function<const EvaluationRow*(const EvaluationReport&)>;
const EvaluationRow* object_of(const EvaluationReport& r) { return &r.object; }
const EvaluationRow* paint_of(const EvaluationReport& r) {
  return r.paint.empty() ? nullptr : &r.paint.front();
}
const EvaluationRow* part_of(const EvaluationReport& r) { return r.part.empty() ? nullptr : &r.part.front(); }

// One of the lists of rows of a report.
using Rows = std::vector<EvaluationRow> EvaluationReport::*;

// The row of that name, unless it was skipped.
RowOf named(Rows rows, const std::string& name) {
  return [rows, name](const EvaluationReport& r) -> const EvaluationRow* {
    for (const EvaluationRow& row : r.*rows)
      if (row.name == name && row.skipped.empty()) return &row;
    return nullptr;
  };
}

// The rows of any capture that were not skipped, one of each name, in the order in which they appear.
std::vector<const EvaluationRow*> kinds_of(const std::vector<EvaluatedCapture>& captures, Rows rows) {
  std::vector<const EvaluationRow*> kinds;
  for (const EvaluatedCapture& c : captures)
    for (const EvaluationReport& r : c.reports)
      for (const EvaluationRow& row : r.*rows) {
        const auto same = [&](const EvaluationRow* k) { return k->name == row.name; };
        if (row.skipped.empty() && std::none_of(kinds.begin(), kinds.end(), same)) kinds.push_back(&row);
      }
  return kinds;
}

struct Column {
  std::string name;
  RowOf row_of;
  const Score* score;
};

std::vector<Column> columns_of(const RowOf& row_of, const std::vector<Score>& scores) {
  std::vector<Column> columns;
  for (const Score& s : scores) columns.push_back({s.name, row_of, &s});
  return columns;
}

// Mean and spread of a score over a capture's seeds.
Spread score_of(const EvaluatedCapture& c, const RowOf& row_of, const Score& score) {
  std::vector<double> values;
  for (const EvaluationReport& r : c.reports)
    if (const EvaluationRow* row = row_of(r))
      if (const auto v = score.of(*row)) values.push_back(*v);
  return spread_of(values);
}

// Mean and spread of a score over the captures' means.
Spread mean_of(const std::vector<EvaluatedCapture>& captures, const RowOf& row_of, const Score& score) {
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

std::string table(const std::string& title, const std::vector<EvaluatedCapture>& captures,
                  const std::vector<Column>& columns) {
  std::vector<Column> used;
  for (const Column& c : columns)
    if (mean_of(captures, c.row_of, *c.score).n > 0) used.push_back(c);
  if (used.empty()) return "";
  std::string head = "| capture |", rule = "|---|", body;
  for (const Column& c : used) head += fmt::format(" {} |", c.name), rule += "---|";
  for (const EvaluatedCapture& e : captures) {
    if (!e.failed.empty()) continue;
    body += fmt::format("| [{0}]({0}/) |", e.name);
    for (const Column& c : used)
      body += fmt::format(" {} |", cell(score_of(e, c.row_of, *c.score), c.score->digits, true));
    body += "\n";
  }
  body += "| **mean** |";
  for (const Column& c : used)
    body += fmt::format(" {} |", cell(mean_of(captures, c.row_of, *c.score), c.score->digits, false));
  return fmt::format("\n## {}\n\n{}\n{}\n{}\n", title, head, rule, body);
}

// A table for each kind of row.
std::string edit_tables(const std::vector<EvaluatedCapture>& captures, Rows rows) {
  std::string text;
  for (const EvaluationRow* kind : kinds_of(captures, rows))
    text += table("Another edit: " + kind->what, captures, columns_of(named(rows, kind->name), kEdit));
  return text;
}

// A table for each score that tells how good the objects are, whose columns are the kinds of rows.
std::string trial_tables(const std::string& title, const std::vector<EvaluatedCapture>& captures, Rows rows) {
  std::string text;
  for (const Score& s : kViews) {
    if (s.key == std::string("seconds")) continue;
    std::vector<Column> columns;
    for (const EvaluationRow* kind : kinds_of(captures, rows))
      columns.push_back({kind->what, named(rows, kind->name), &s});
    text += table(fmt::format("{}: {}", title, s.name), captures, columns);
  }
  return text;
}

Json means_json(const std::vector<EvaluatedCapture>& captures, const RowOf& row_of,
                const std::vector<Score>& scores) {
  Json j = Json::object();
  for (const Score& s : scores)
    if (const Spread m = mean_of(captures, row_of, s); m.n > 0) j[s.key] = m.mean;
  return j;
}

// By name of the row.
Json means_by_kind(const std::vector<EvaluatedCapture>& captures, Rows rows,
                   const std::vector<Score>& scores) {
  Json j = Json::object();
  for (const EvaluationRow* kind : kinds_of(captures, rows))
    j[kind->name] = means_json(captures, named(rows, kind->name), scores);
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
            {"part", means_json(captures, part_of, kEdit)},
            {"applications", means_by_kind(captures, &EvaluationReport::applications, kEdit)},
            {"fewer_views", means_by_kind(captures, &EvaluationReport::views, kViews)},
            {"sizes", means_by_kind(captures, &EvaluationReport::sizes, kViews)}}},
          {"captures", list}};
}

std::string EvaluationSetReport::markdown() const {
  std::string text = fmt::format(
      "# Evaluation of {} captures\n\nBy cei3d {}. docs/evaluation.md defines the scores; ± is the standard "
      "deviation over seeds. Each capture has a report of its own.\n",
      captures.size(), kVersion);
  text += table("Novel views", captures, columns_of(object_of, kViews));
  text += table("A painted edit", captures, columns_of(paint_of, kEdit));
  text += table("A part by clicks", captures, columns_of(part_of, kEdit));
  text += edit_tables(captures, &EvaluationReport::applications);
  text += trial_tables("Fewer photographs", captures, &EvaluationReport::views);
  text += trial_tables("Smaller photographs", captures, &EvaluationReport::sizes);
  for (const EvaluatedCapture& c : captures)
    if (!c.failed.empty()) text += fmt::format("\n{} could not be evaluated: {}\n", c.name, c.failed);
  return text;
}

}  // namespace cei3d

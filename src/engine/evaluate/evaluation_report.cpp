// SPDX-License-Identifier: Apache-2.0
// Tables of the evaluation report.
#include "core/base/error.h"
#include "core/base/json_reader.h"
#include "engine/evaluate/evaluation.h"
#include "engine/session/number_text.h"
#include "engine/session/version.h"

namespace cei3d {
namespace {

using Rows = std::vector<EvaluationRow>;

Json rows_json(const Rows& rows) {
  Json list = Json::array();
  for (const EvaluationRow& r : rows) list.push_back(r.json());
  return list;
}

// A column: its name, and the text of a row; columns without any text are left out.
struct Column {
  std::string name;
  std::string (*cell)(const EvaluationRow&);
};

std::string table(const Rows& rows, const std::vector<Column>& columns) {
  std::vector<Column> used;
  for (const Column& c : columns)
    for (const EvaluationRow& r : rows)
      if (r.skipped.empty() && !c.cell(r).empty()) {
        used.push_back(c);
        break;
      }
  std::string head = "| |", rule = "|---|", body;
  for (const Column& c : used) {
    head += fmt::format(" {} |", c.name);
    rule += "---|";
  }
  for (const EvaluationRow& r : rows) {
    body += fmt::format("| {} |", r.what);
    for (const Column& c : used) body += fmt::format(" {} |", r.skipped.empty() ? c.cell(r) : "-");
    body += "\n";
  }
  for (const EvaluationRow& r : rows)
    if (!r.skipped.empty()) body += fmt::format("\nSkipped, {}: {}\n", r.what, r.skipped);
  return head + "\n" + rule + "\n" + body;
}

std::string db(double v) { return decibels_text(v); }

template <class T>
std::string or_nothing(const std::optional<T>& value, fmt::format_string<const T&> format) {
  return value ? fmt::format(format, *value) : std::string();
}

const EditScore* edit_of(const EvaluationRow& r) { return r.scores.edit ? &*r.scores.edit : nullptr; }
const EditFidelity* truth_of(const EvaluationRow& r) {
  const EditScore* e = edit_of(r);
  return e && e->truth ? &*e->truth : nullptr;
}
const RestScore* rest_of(const EvaluationRow& r) {
  const EditScore* e = edit_of(r);
  return e && e->rest ? &*e->rest : nullptr;
}

const Column kMadeIn{"made in, s", [](const EvaluationRow& r) {
                       return r.seconds > 0 ? fmt::format("{:.0f}", r.seconds) : "";
                     }};
const std::vector<Column> kNovelViews{
    {"PSNR on white", [](const EvaluationRow& r) { return db(r.scores.psnr); }},
    {"worst view",
     [](const EvaluationRow& r) {
       return fmt::format("{} ({})", db(r.scores.psnr_worst), r.scores.worst_view);
     }},
    {"SSIM", [](const EvaluationRow& r) { return fmt::format("{:.4f}", r.scores.ssim); }},
    {"PSNR in the mask", [](const EvaluationRow& r) { return db(r.scores.psnr_masked); }},
    {"the same at the photographs' exposures",
     [](const EvaluationRow& r) { return r.scores.psnr_exposed ? db(*r.scores.psnr_exposed) : ""; }},
    {"light and material alone: PSNR, in the mask",
     [](const EvaluationRow& r) {
       const auto& alone = r.scores.alone;
       return alone ? fmt::format("{}, {}", db(alone->psnr), db(alone->psnr_masked)) : "";
     }},
    {"FLIP", [](const EvaluationRow& r) { return or_nothing(r.scores.flip, "{:.4f}"); }},
    {"LPIPS", [](const EvaluationRow& r) { return or_nothing(r.scores.lpips, "{:.4f}"); }},
    {"FID", [](const EvaluationRow& r) { return or_nothing(r.scores.fid, "{:.1f}"); }},
    {"rendered with", [](const EvaluationRow& r) {
       return std::string(r.scores.residual ? "light, material, correction" : "light, material");
     }}};
const std::vector<Column> kFidelity{
    {"PSNR inside the edit",
     [](const EvaluationRow& r) { return truth_of(r) ? db(truth_of(r)->psnr_inside) : ""; }},
    {"IoU",
     [](const EvaluationRow& r) { return truth_of(r) ? fmt::format("{:.3f}", truth_of(r)->iou) : ""; }},
    {"pixels changed outside", [](const EvaluationRow& r) {
       return truth_of(r) ? fmt::format("{} of {}", truth_of(r)->changed_outside, truth_of(r)->pixels_outside)
                          : "";
     }}};
const std::vector<Column> kRest{
    {"non-edited area: PSNR", [](const EvaluationRow& r) { return rest_of(r) ? db(rest_of(r)->psnr) : ""; }},
    {"SSIM",
     [](const EvaluationRow& r) { return rest_of(r) ? fmt::format("{:.4f}", rest_of(r)->ssim) : ""; }},
    {"FLIP", [](const EvaluationRow& r) { return rest_of(r) ? or_nothing(rest_of(r)->flip, "{:.4f}") : ""; }},
    {"LPIPS",
     [](const EvaluationRow& r) { return rest_of(r) ? or_nothing(rest_of(r)->lpips, "{:.4f}") : ""; }},
    {"FID before/after",
     [](const EvaluationRow& r) { return edit_of(r) ? or_nothing(edit_of(r)->fid, "{:.1f}") : ""; }}};
const Column kEditTime{"edit, s", [](const EvaluationRow& r) { return fmt::format("{:.2f}", r.seconds); }};
const Column kPoints{"handler points", [](const EvaluationRow& r) {
                       return r.details.contains("points") ? r.details.at("points").dump() : "";
                     }};
const Column kShare{"of the surface, %", [](const EvaluationRow& r) {
                      return r.details.contains("share")
                                 ? fmt::format("{:.1f}", 100 * r.details.at("share").get<double>())
                                 : "";
                    }};

std::vector<Column> columns(std::initializer_list<std::vector<Column>> groups) {
  std::vector<Column> all;
  for (const auto& g : groups) all.insert(all.end(), g.begin(), g.end());
  return all;
}

// Where the images of the rows are.
std::string pictures_of(const Rows& rows) {
  std::string text;
  for (const EvaluationRow& r : rows)
    if (r.skipped.empty())
      text += fmt::format("{}[{}](pictures/{}/)", text.empty() ? "" : ", ", r.name, r.name);
  return text.empty() ? "" : fmt::format("\nImages: {}\n", text);
}

std::string section(const std::string& title, const std::string& words, const Rows& rows,
                    const std::vector<Column>& c) {
  if (rows.empty()) return "";
  return fmt::format("\n## {}\n\n{}\n\n{}{}", title, words, table(rows, c), pictures_of(rows));
}

std::string worst_picture(const EvaluationRow& r) {
  const std::string file = std::filesystem::path(r.scores.worst_view).filename().string();
  return fmt::format("\n![photograph and render of {}](pictures/{}/{}.png)\n", r.scores.worst_view, r.name,
                     file);
}

}  // namespace

Json EvaluationRow::json() const {
  Json j = {{"name", name}, {"what", what}};
  if (!skipped.empty()) {
    j["skipped"] = skipped;
    return j;
  }
  j["seconds"] = seconds;
  j["details"] = details;
  j["scores"] = scores.json();
  return j;
}

EvaluationRow evaluation_row_from_json(const Json& j, const std::string& what) {
  JsonReader reader(j, what);
  EvaluationRow r{reader.require<std::string>("name"),
                  reader.require<std::string>("what"),
                  reader.optional("skipped", std::string()),
                  0,
                  {},
                  {}};
  if (r.skipped.empty()) {
    r.seconds = reader.require<double>("seconds");
    r.details = reader.member("details");
    r.scores = eval_report_from_json(reader.member("scores"), "'scores' of " + what);
  }
  reader.finish();
  return r;
}

Json EvaluationReport::json() const {
  return {{"program", std::string("cei3d ") + kVersion},
          {"capture", capture},
          {"object", object.json()},
          {"paint", rows_json(paint)},
          {"part", rows_json(part)},
          {"applications", rows_json(applications)},
          {"views", rows_json(views)},
          {"sizes", rows_json(sizes)}};
}

std::string EvaluationReport::markdown() const {
  std::string text = fmt::format(
      "# Evaluation of {}\n\nBy cei3d {}. docs/evaluation.md defines the scores.\n", capture, kVersion);
  text += section("Novel views",
                  "Held-out views, rendered and compared with their photographs; the worst one is shown.",
                  {object}, columns({{kMadeIn}, kNovelViews}));
  text += worst_picture(object);
  text += fmt::format("\nMaterial and light found: {}.\n", object.details.value("found", ""));
  text += section(
      "A painted edit, and the method without its parts",
      "The same scribble on one view, scored in all held-out views. Images: photograph, before, after.",
      paint, columns({{kEditTime, kPoints}, kFidelity, kRest}));
  text += section("A part by clicks, with and without propagation",
                  "The same clicks in one view; the part is recolored.", part,
                  columns({{kEditTime, kPoints, kShare}, kFidelity, kRest}));
  text += section("Other edits", "Of the whole object and of its shape; images: photograph, before, after.",
                  applications, columns({{kEditTime}, kRest}));
  const std::vector<Column> trials = columns({{kMadeIn}, kNovelViews, kFidelity, kRest});
  text += section("Fewer photographs",
                  "Spread evenly; scored on the same held-out views, with the same scribble.", views, trials);
  text += section("Smaller photographs",
                  "Scored at full size on the same held-out views, with the same scribble.", sizes, trials);
  return text;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/index.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/batch/csv.h"
#include "engine/batch/index_page.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFigures[] = {"psnr", "psnr_worst", "psnr_masked", "psnr_alone", "ssim"};

// A member of a member, or null.
Json member_of(const Json& j, const char* step, const char* key) {
  const auto at = j.find(step);
  return at == j.end() || !at->is_object() || !at->contains(key) ? Json() : at->at(key);
}

Json warnings_of(const Json& result) {
  Json out = member_of(result, "check", "warnings");
  if (!out.is_array()) out = Json::array();
  if (const Json w = member_of(result, "project", "warning"); w.is_string() && !w.get<std::string>().empty())
    out.push_back(w);
  return out;
}

// By variant: files below the folder of the object.
Json files_of(const Json& result) {
  const std::string kExport = "export/";
  Json out = Json::object();
  for (const auto& [step, found] : result.items())
    if (step.starts_with(kExport) && found.contains("files"))
      for (const Json& file : found.at("files"))
        out[step.substr(kExport.size())].push_back(step + "/" + file.get<std::string>());
  return out;
}

// A picture below the folder of the object: of its figures, else the first one of a turntable; else null.
Json thumbnail_of(const Json& result) {
  if (result.contains("figures")) return "figures/thumbnail.png";
  for (const auto& [step, found] : result.items())
    if (step.starts_with("turntable/") && found.contains("picture"))
      return step + "/" + found.at("picture").get<std::string>();
  return nullptr;
}

Json row_of(const BatchItemStatus& item, const fs::path& catalog, const Json& tags) {
  const BatchState s = item.state.value_or(BatchState());
  Json j{{"id", item.id},
         {"state", item.running ? "running" : batch_outcome_name(s.outcome)},
         {"sentence", s.reason},
         {"folder", batch_item_folder(catalog, item.id).string()}};
  for (const char* figure : kFigures) j[figure] = member_of(s.result, "figures", figure);
  j["worst_view"] = member_of(s.result, "figures", "worst_view");
  j["vertices"] = member_of(s.result, "project", "vertices");
  j["material"] = member_of(s.result, "project", "material");
  j["views"] = member_of(s.result, "check", "views");
  j["warnings"] = warnings_of(s.result);
  j["files"] = files_of(s.result);
  j["thumbnail"] = thumbnail_of(s.result);
  j["seconds"] = s.seconds;
  j["peak_memory_gib"] = s.peak_memory_gib;
  j["attempt"] = s.attempt;
  j["host"] = s.host;
  j["tags"] = tags;
  return j;
}

// Failed objects first, those that are not made yet last.
double rank_of(const Json& row) {
  constexpr double kLast = std::numeric_limits<double>::infinity();
  if (row.at("state") == "failed") return -kLast;
  return row.at("psnr_worst").is_number() ? row.at("psnr_worst").get<double>() : kLast;
}

std::vector<Json> rows_of(const BatchCatalog& catalog, const BatchManifest& manifest) {
  std::vector<Json> rows;
  const std::vector<BatchItemStatus> items = batch_item_states(catalog, manifest);
  rows.reserve(items.size());
  for (size_t i = 0; i < items.size(); ++i)
    rows.push_back(row_of(items[i], catalog.folder(), manifest.line(i).value("tags", Json::object())));
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < rows.size(); ++i) order.emplace_back(rank_of(rows[i]), i);
  std::sort(order.begin(), order.end());
  std::vector<Json> out;
  for (const auto& [rank, i] : order) out.push_back(std::move(rows[i]));
  return out;
}

std::string field_of(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Tags have columns of their own, called as in a manifest.
std::string csv_of(const std::vector<Json>& rows) {
  if (rows.empty()) return "";
  std::vector<std::string> columns;
  for (const auto& [key, value] : rows.front().items())
    if (!value.is_structured()) columns.push_back(key);
  std::set<std::string> tags;
  for (const Json& row : rows)
    for (const auto& [name, value] : row.at("tags").items()) tags.insert(name);
  std::vector<std::string> head = columns;
  for (const std::string& tag : tags) head.push_back("tag." + tag);
  std::string out = csv_line(head);
  for (const Json& row : rows) {
    std::vector<std::string> fields;
    for (const std::string& c : columns) fields.push_back(field_of(row.at(c)));
    for (const std::string& tag : tags) fields.push_back(field_of(row.at("tags").value(tag, Json())));
    out += csv_line(fields);
  }
  return out;
}

std::string json_of(const std::vector<Json>& rows) {
  std::string out = "[\n";
  for (size_t i = 0; i < rows.size(); ++i)
    out +=
        rows[i].dump(-1, ' ', false, Json::error_handler_t::replace) + (i + 1 < rows.size() ? ",\n" : "\n");
  return out + "]\n";
}

}  // namespace

size_t write_batch_index(const BatchCatalog& catalog, const BatchManifest& manifest, const fs::path& out) {
  const std::string kind = out.extension().string();
  if (kind != ".json" && kind != ".csv" && kind != ".html")
    fail_usage("{}: the ending says what to write: .html, .json or .csv.", out.string());
  const std::vector<Json> rows = rows_of(catalog, manifest);
  if (kind == ".html")
    write_index_pages(rows, catalog.folder(), out);
  else
    write_file_atomic(out, kind == ".csv" ? csv_of(rows) : json_of(rows));
  return rows.size();
}

}  // namespace cei3d

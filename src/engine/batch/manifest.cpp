// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/manifest.h"

#include <algorithm>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json_reader.h"
#include "core/base/parse_json.h"
#include "engine/batch/csv.h"
#include "engine/session/version.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr int kCatalogVersion = 1;

Json parsed(std::string_view text, const std::string& what) {
  Json j = parse_json(text);
  if (!j.is_object()) fail("{} is not a JSON object.", what);
  return j;
}

// `id` is the first key of the lines that this program writes.
std::string id_of(std::string_view line, const std::string& what) {
  constexpr std::string_view kBegin = "{\"id\":\"";
  if (line.starts_with(kBegin)) {
    const std::string_view rest = line.substr(kBegin.size());
    return std::string(rest.substr(0, rest.find('"')));
  }
  const Json j = parsed(line, what);
  return JsonReader(j, what).require<std::string>("id");
}

// With `id` in front and the capture's absolute path.
std::string normal_line(const Json& line, const fs::path& base) {
  Json out{{"id", line.value("id", Json())}};
  for (const auto& [key, value] : line.items()) out[key] = value;
  if (out.contains("capture") && out["capture"].is_string())
    out["capture"] = (base / out["capture"].get<std::string>()).lexically_normal().string();
  return out.dump() + "\n";
}

std::string jsonl_text(const std::string& bytes, const fs::path& file, const fs::path& base) {
  std::string out;
  size_t number = 0;
  for (size_t begin = 0; begin < bytes.size();) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string_view line = std::string_view(bytes).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.find_first_not_of(" \t\r") == line.npos) continue;
    out += normal_line(parsed(line, fmt::format("{}, line {}", file.string(), number)), base);
  }
  return out;
}

}  // namespace

BatchManifest BatchManifest::read(const fs::path& file) {
  const fs::path base = fs::absolute(file).parent_path();
  const std::string bytes = read_file(file);
  // Manifests in a catalog are as this program writes them.
  if (base.filename() == "manifests" && file.stem() == content_hash(bytes)) return {bytes, file.string()};
  if (file.extension() != ".csv") return {jsonl_text(bytes, file, base), file.string()};
  std::string text;
  for (const Json& line : lines_of_csv(bytes, file.string())) text += normal_line(line, base);
  return {text, file.string()};
}

BatchManifest BatchManifest::of(const std::vector<Json>& lines) {
  std::string text;
  for (const Json& line : lines) text += normal_line(line, fs::current_path());
  return {text, "The manifest"};
}

BatchManifest::BatchManifest(std::string text, std::string name)
    : text_(std::move(text)), name_(std::move(name)) {
  std::unordered_set<std::string_view> seen;
  for (size_t begin = 0; begin < text_.size(); begin = text_.find('\n', begin) + 1) begins_.push_back(begin);
  ids_.reserve(begins_.size());
  for (size_t i = 0; i < begins_.size(); ++i) {
    ids_.push_back(id_of(raw(i), line_name(i)));
    if (!is_batch_id(ids_[i]))
      fail("{}: '{}' cannot be an id, which is a folder's name: letters, digits, '.', '_' and '-'.",
           line_name(i), ids_[i]);
    if (!seen.insert(ids_[i]).second) fail("{}: the id '{}' is there twice.", line_name(i), ids_[i]);
  }
  if (ids_.empty()) fail("{} names no object.", name_);
}

std::string_view BatchManifest::raw(size_t i) const {
  const size_t end = i + 1 < begins_.size() ? begins_[i + 1] : text_.size();
  return std::string_view(text_).substr(begins_[i], end - begins_[i] - 1);
}

Json BatchManifest::line(size_t i) const { return parsed(raw(i), line_name(i)); }
std::string BatchManifest::line_name(size_t i) const { return fmt::format("{}, object {}", name_, i); }

std::string BatchManifest::text_of(const std::vector<size_t>& lines) const {
  std::string out;
  for (const size_t i : lines) out.append(raw(i)) += '\n';
  return out;
}

BatchCatalog::BatchCatalog(fs::path folder) : folder_(fs::absolute(std::move(folder)).lexically_normal()) {
  const fs::path file = folder_ / "batch.json";
  std::error_code error;
  if (!fs::exists(file, error)) return;
  const Json j = parsed(read_file(file), file.string());
  JsonReader r(j, file.string());
  if (r.require<int>("version") > kCatalogVersion)
    fail("{} was written by a newer cei3d; update this one.", file.string());
  r.require<std::string>("program");
  manifest_ = r.require<std::string>("manifest");
  settings_.defaults = r.member("defaults");
  settings_.retries = r.require<int>("retries");
  settings_.timing = {r.require<double>("beat"), r.require<double>("stale")};
  r.finish();
}

void BatchCatalog::prepare(const BatchManifest& manifest, const BatchSettings& settings) {
  settings_ = settings;
  for (size_t i = 0; i < manifest.size(); ++i) item(manifest, i);
  manifest_ = store(manifest.text()).filename().string();
  const Json j{{"version", kCatalogVersion},    {"program", kVersion},         {"manifest", manifest_},
               {"defaults", settings.defaults}, {"retries", settings.retries}, {"beat", settings.timing.beat},
               {"stale", settings.timing.stale}};
  write_file_atomic(folder_ / "batch.json", j.dump(1) + "\n");
}

fs::path BatchCatalog::manifest_file() const {
  if (!prepared())
    fail("{} is no catalog: it has no batch.json. `cei3d batch run MANIFEST -o {}` makes one.",
         folder_.string(), folder_.string());
  return folder_ / "manifests" / manifest_;
}

BatchItem BatchCatalog::item(const BatchManifest& manifest, size_t i) const {
  return batch_item_from(with_defaults(settings_.defaults, manifest.line(i)), manifest.line_name(i));
}

fs::path BatchCatalog::store(const std::string& manifest_text) const {
  const fs::path file = folder_ / "manifests" / (content_hash(manifest_text) + ".jsonl");
  std::error_code error;
  if (!fs::exists(file, error)) write_file_atomic(file, manifest_text);
  return file;
}

}  // namespace cei3d

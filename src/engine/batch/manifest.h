// SPDX-License-Identifier: Apache-2.0
// Lists of objects, and the folder of a catalog:
//
//   batch.json                the manifest in use, and what holds for all objects
//   manifests/<hash>.jsonl    manifests, never changed, because schedulers count their lines
//   items/ab/<id>/            an object: state.json and the results of its steps
//   logs/, slurm/             what launchers and workers printed
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"
#include "engine/batch/attempt.h"
#include "engine/batch/item.h"

namespace cei3d {

// One object a line.
class BatchManifest {
 public:
  // A file of JSON lines, or .csv with a head line: id, capture, steps, export (both with ';' between words),
  // for, unit_scale, the names of options of `reconstruct`, and tag.NAME. Relative captures are meant from
  // its folder. Errors: unreadable, an unknown column, an id that is missing, bad or there twice.
  static BatchManifest read(const std::filesystem::path&);
  static BatchManifest of(const std::vector<Json>& lines);

  size_t size() const { return ids_.size(); }
  const std::string& id(size_t i) const { return ids_[i]; }
  Json line(size_t i) const;
  std::string line_name(size_t i) const;  // for errors
  const std::string& text() const { return text_; }
  std::string text_of(const std::vector<size_t>& lines) const;  // a manifest of some of them

 private:
  BatchManifest(std::string text, std::string name);
  std::string_view raw(size_t i) const;
  std::string text_, name_;  // every line with its end
  std::vector<size_t> begins_;
  std::vector<std::string> ids_;
};

// What holds for all objects of a catalog.
struct BatchSettings {
  Json defaults = Json::object();  // of the lines of its manifest
  int retries = 3;                 // attempts after one that was killed
  BatchTiming timing;
};

class BatchCatalog {
 public:
  explicit BatchCatalog(std::filesystem::path folder);  // as batch.json says, where there is one
  // Puts the manifest into use. Error: a line of it cannot be used with these settings.
  void prepare(const BatchManifest&, const BatchSettings&);

  bool prepared() const { return !manifest_.empty(); }
  const std::filesystem::path& folder() const { return folder_; }
  const BatchSettings& settings() const { return settings_; }
  std::filesystem::path manifest_file() const;  // error: no manifest is in use
  BatchItem item(const BatchManifest&, size_t i) const;
  // Stores lines of a manifest as one of their own.
  std::filesystem::path store(const std::string& manifest_text) const;

 private:
  std::filesystem::path folder_;
  std::string manifest_;
  BatchSettings settings_;
};

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Values that took long to work out, kept in a folder with the settings that they were worked out with.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json.h"

namespace cei3d {

class KeptValues {
 public:
  explicit KeptValues(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // Null: there is none, or it was worked out with other settings.
  Json find(const std::string& name, const Json& settings) const;
  void put(const std::string& name, const Json& settings, const Json& value) const;

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }
  std::filesystem::path folder_;
};

}  // namespace cei3d

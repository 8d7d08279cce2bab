// SPDX-License-Identifier: Apache-2.0
// Results of long computations, stored in a folder together with the settings that they depend on.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/json_fwd.h"

namespace cei3d {

class KeptValues {
 public:
  explicit KeptValues(std::filesystem::path folder) : folder_(std::move(folder)) {}
  // Null: no value, or one of other settings.
  Json find(const std::string& name, const Json& settings) const;
  void put(const std::string& name, const Json& settings, const Json& value) const;

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }
  std::filesystem::path folder_;
};

}  // namespace cei3d

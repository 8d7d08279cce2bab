// SPDX-License-Identifier: Apache-2.0
// The numbers and choices of a preset by name, for `--set` and `--list-settings`.
#pragma once

#include "core/base/settings.h"
#include "engine/reconstruct/presets.h"

namespace cei3d {

const SettingTable<Preset>& preset_settings();

// Whether fit_to_footprint() chooses the value from the size of a pixel, unless it is set.
bool is_fitted(const Preset&, const std::string& key);

}  // namespace cei3d

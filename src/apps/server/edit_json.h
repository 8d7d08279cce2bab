// SPDX-License-Identifier: Apache-2.0
// Requests of the browser, from JSON. The keys are the long options of the command line.
#pragma once

#include <string>

#include "apps/server/uploads.h"
#include "core/base/json_reader.h"
#include "engine/session/look_requests.h"

namespace cei3d {

// op: "paint", "material", "light", "deform", "remove", "part". Files are ids of uploads. Errors: unknown
// operation or key, values of another type.
EditCommand edit_command(const std::string& op, const Json& params, const Uploads&);

Camera camera_member(JsonReader&, const char* key);  // an object as camera_json() writes it
// Key "decal": {"pixel", "width", "turn"}.
DecalPlace decal_place(JsonReader&);
// Keys "env" (id of an upload), "rotate", "scale", "env_convention", "sun": {"direction", "strength"}.
LightChoice light_choice(JsonReader&, const Uploads&);
// Keys "camera", "channel", "samples", "light", "as_photographed".
FrameRequest frame_request(JsonReader&, const Uploads&);
// Keys "file" (a name; folders in it are ignored), "for", "faces", "texture", "image", "origin", "size"
// (meters), "unit_scale", "points", "light".
ExportRequest export_request(JsonReader&);
// Keys "turntable" (number of frames), "samples", "size": [width, height]. The caller sets the folder.
RenderRequest turntable_request(JsonReader&);

}  // namespace cei3d

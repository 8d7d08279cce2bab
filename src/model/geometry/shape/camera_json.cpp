// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/camera_json.h"

#include "core/base/json.h"
#include "model/geometry/shape/vec_json.h"

namespace cei3d {
namespace {

Mat3d rotation_from(JsonReader& reader) {
  const Json& rows = reader.array("world_from_cam");
  Mat3d m;
  for (size_t i = 0; i < 3; ++i) {
    const Json row{{"world_from_cam", rows.size() == 3 ? rows[i] : Json()}};
    JsonReader row_reader(row, reader.what());
    m.row[i] = vector_from(row_reader, "world_from_cam");
  }
  return m;
}

}  // namespace

Json camera_json(const Camera& c) {
  Json rotation = Json::array();
  for (const Vec3d& row : c.world_from_cam.row) rotation.push_back(vector_json(row));
  return {{"width", c.width},
          {"height", c.height},
          {"fx", c.fx},
          {"fy", c.fy},
          {"cx", c.cx},
          {"cy", c.cy},
          {"skew", c.skew},
          {"world_from_cam", std::move(rotation)},
          {"center", vector_json(c.center)}};
}

Camera camera_from_json(JsonReader& reader) {
  Camera c;
  c.width = reader.require<int>("width");
  c.height = reader.require<int>("height");
  c.fx = reader.require<double>("fx");
  c.fy = reader.require<double>("fy");
  c.cx = reader.require<double>("cx");
  c.cy = reader.require<double>("cy");
  c.skew = reader.optional("skew", 0.0);
  c.world_from_cam = rotation_from(reader);
  c.center = vector_from(reader, "center");
  return c;
}

}  // namespace cei3d

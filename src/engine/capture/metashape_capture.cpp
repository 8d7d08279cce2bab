// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string_view>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/photograph_index.h"
#include "engine/capture/words.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

struct Sensor {
  Camera k;
  LensDistortion lens;
};

// From a component's frame to that of the chunk.
struct Similarity {
  Mat3d rotation = Mat3d::identity();
  Vec3d translation{0, 0, 0};
  double scale = 1;
};

bool is_metashape_file(const fs::path& path) {
  if (path.extension() != ".xml" || !fs::is_regular_file(path)) return false;
  const std::string start = read_file(path).substr(0, 4096);
  return start.find("<document") != std::string::npos && start.find("<chunk") != std::string::npos;
}

fs::path xml_of(const fs::path& path) {
  if (fs::is_regular_file(path)) return is_metashape_file(path) ? path : fs::path();
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error))
    if (is_metashape_file(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files.empty() ? fs::path() : files[0];
}

template <size_t N>
std::array<double, N> numbers_of(const pugi::xml_node& node, const std::string& where) {
  const std::string text = node.text().get();
  Words words(text, where, " \t\r\n");
  std::array<double, N> out{};
  for (double& v : out)
    if (!std::isfinite(v = words.number())) fail("{} holds a number that is not finite.", where);
  return out;
}

double number_in(const pugi::xml_node& parent, const char* name, const std::string& where, double otherwise) {
  const pugi::xml_node node = parent.child(name);
  return node ? numbers_of<1>(node, fmt::format("<{}> of {}", name, where))[0] : otherwise;
}

// The adjusted calibration, or the only one.
pugi::xml_node calibration_of(const pugi::xml_node& sensor) {
  const pugi::xml_node adjusted = sensor.find_child_by_attribute("calibration", "class", "adjusted");
  return adjusted ? adjusted : sensor.child("calibration");
}

// u = w / 2 + cx + x f + x b1 + y b2, v = h / 2 + cy + y f; p1 and p2 are swapped against OpenCV's.
Sensor read_sensor(const pugi::xml_node& node, const std::string& where) {
  Sensor s;
  const pugi::xml_node size = node.child("resolution"), c = calibration_of(node);
  s.k.width = size.attribute("width").as_int(), s.k.height = size.attribute("height").as_int();
  if (s.k.width < 1 || s.k.height < 1 || s.k.width > 65535 || s.k.height > 65535)
    fail("{} gives an impossible image size.", where);
  const auto value = [&](const char* name) { return number_in(c, name, where, 0); };
  s.k.fy = number_in(c, "f", where, number_in(c, "fy", where, 0));
  s.k.fx = s.k.fy + value("b1");
  s.k.skew = value("b2");
  s.k.cx = s.k.width / 2.0 + value("cx"), s.k.cy = s.k.height / 2.0 + value("cy");
  if (!(s.k.fx > 0 && s.k.fy > 0))
    fail("{} has no calibration with a focal length. Align the photographs before exporting the cameras.",
         where);
  s.lens.radial = {value("k1"), value("k2"), value("k3"), value("k4")};
  s.lens.p1 = value("p2"), s.lens.p2 = value("p1");
  const std::string type = node.attribute("type").as_string("frame");
  if (type == "fisheye" || type == "equidistant_fisheye") s.lens.kind = LensKind::fisheye;
  const bool more_terms = value("p3") != 0 || value("p4") != 0;
  const bool tangential_fisheye = s.lens.kind == LensKind::fisheye && (s.lens.p1 != 0 || s.lens.p2 != 0);
  if ((type != "frame" && s.lens.kind != LensKind::fisheye) || more_terms || tangential_fisheye)
    fail("{} has a camera model that is not supported (type {}). Export undistorted photographs.", where,
         type);
  return s;
}

Similarity read_component(const pugi::xml_node& node, const std::string& where) {
  Similarity s;
  const pugi::xml_node t = node.child("transform");
  if (!t) return s;
  if (t.child("rotation")) {
    const auto r = numbers_of<9>(t.child("rotation"), where);
    for (size_t i = 0; i < 3; ++i) s.rotation.row[i] = {r[3 * i], r[3 * i + 1], r[3 * i + 2]};
  }
  if (t.child("translation")) {
    const auto p = numbers_of<3>(t.child("translation"), where);
    s.translation = {p[0], p[1], p[2]};
  }
  s.scale = number_in(t, "scale", where, 1);
  return s;
}

// Camera to chunk, OpenCV axes, row-major 4 x 4.
void set_pose(Camera& camera, const pugi::xml_node& transform, const Similarity& placed,
              const std::string& where) {
  const auto m = numbers_of<16>(transform, where);
  Mat3d r;
  for (size_t i = 0; i < 3; ++i) r.row[i] = {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
  camera.world_from_cam = placed.rotation * r;
  camera.center = placed.rotation * Vec3d{m[3], m[7], m[11]} * placed.scale + placed.translation;
}

struct Chunk {
  std::map<std::string, Sensor> sensors;
  std::map<std::string, Similarity> components;
};

Chunk read_chunk(const pugi::xml_node& node, const std::string& file) {
  Chunk chunk;
  for (const pugi::xml_node s : node.child("sensors").children("sensor"))
    if (calibration_of(s))
      chunk.sensors[s.attribute("id").as_string()] =
          read_sensor(s, fmt::format("Sensor {} of {}", s.attribute("id").as_string(), file));
  // The frame of a single component is as good as that of the chunk.
  const pugi::xml_node components = node.child("components");
  if (components.first_child() != components.last_child())
    for (const pugi::xml_node c : components.children("component"))
      chunk.components[c.attribute("id").as_string()] =
          read_component(c, fmt::format("Component {} of {}", c.attribute("id").as_string(), file));
  return chunk;
}

// Finds the cameras that are switched on; they may stand in groups.
void collect_cameras(const pugi::xml_node& node, std::vector<pugi::xml_node>& out) {
  for (const pugi::xml_node c : node.children())
    if (std::string_view(c.name()) == "group")
      collect_cameras(c, out);
    else if (std::string_view(c.name()) == "camera" && c.attribute("enabled").as_bool(true))
      out.push_back(c);
}

View view_of(const pugi::xml_node& c, const Chunk& chunk, const PhotographIndex& photographs,
             const std::string& file) {
  const std::string label = c.attribute("label").as_string();
  const std::string where = fmt::format("Camera {} of {}", label, file);
  if (label.empty()) fail("{} has no label.", where);
  const auto sensor = chunk.sensors.find(c.attribute("sensor_id").as_string());
  if (sensor == chunk.sensors.end()) fail("{} has no calibrated sensor.", where);
  const auto placed = chunk.components.find(c.attribute("component_id").as_string());
  View view;
  view.name = view_name(with_slashes(label), Split::train);
  view.image_path = photographs.find(label);
  view.camera = sensor->second.k;
  set_pose(view.camera, c.child("transform"),
           placed == chunk.components.end() ? Similarity() : placed->second, where);
  if (distorts(sensor->second.lens)) view.photo = PhotoCamera(view.camera, sensor->second.lens);
  return view;
}

}  // namespace

bool detect_metashape(const fs::path& path) { return !xml_of(path).empty(); }

Capture load_metashape(const fs::path& path) {
  const fs::path file = xml_of(path);
  pugi::xml_document document;
  const std::string text = read_file(file);
  if (const auto result = document.load_buffer(text.data(), text.size()); !result)
    fail("{} is not valid XML (near byte {}). It may be truncated; export it again.", file.string(),
         result.offset);
  const pugi::xml_node node = document.child("document").child("chunk");
  const Chunk chunk = read_chunk(node, file.string());
  Capture capture;
  capture.root = file.parent_path();
  capture.format = "metashape";
  const PhotographIndex photographs(capture.root);
  size_t unaligned = 0;
  std::vector<pugi::xml_node> cameras;
  collect_cameras(node.child("cameras"), cameras);
  for (const pugi::xml_node& c : cameras)
    if (c.child("transform"))
      capture.views.push_back(view_of(c, chunk, photographs, file.string()));
    else
      ++unaligned;
  if (unaligned > 0)
    capture.warnings.push_back(
        fmt::format("{} cameras of {} are not aligned and are left out.", unaligned, file.string()));
  return capture;
}

}  // namespace cei3d

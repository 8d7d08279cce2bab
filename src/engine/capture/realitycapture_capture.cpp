// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/capture/capture_format.h"
#include "engine/capture/photograph_index.h"
#include "engine/capture/words.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

using Row = std::map<std::string, std::string>;  // by column

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    std::string cell(line.substr(begin, end - begin));
    cell.erase(0, cell.find_first_not_of(" \t\""));
    cell.erase(cell.find_last_not_of(" \t\"") + 1);
    cells.push_back(std::move(cell));
    begin = end + 1;
  }
  return cells;
}

// The columns of the header, or none: it is no file of cameras.
std::vector<std::string> header_of(const fs::path& path) {
  if (path.extension() != ".csv" || !fs::is_regular_file(path)) return {};
  const std::string text = read_file(path);
  Lines lines(text);
  if (!lines.next()) return {};
  std::string_view line = lines.line();
  if (line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
  if (!line.starts_with("#")) return {};
  std::vector<std::string> columns = cells_of(line.substr(1));
  for (const char* needed : {"name", "x", "y", "alt", "heading", "pitch", "roll", "f"})
    if (std::find(columns.begin(), columns.end(), needed) == columns.end()) return {};
  return columns;
}

fs::path csv_of(const fs::path& path) {
  if (fs::is_regular_file(path)) return header_of(path).empty() ? fs::path() : path;
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path, error))
    if (!header_of(entry.path()).empty()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files.empty() ? fs::path() : files[0];
}

double number_in(const Row& row, const char* column, const std::string& where) {
  const auto cell = row.find(column);
  if (cell == row.end()) return 0;
  const double value = Words(cell->second, where).number();
  if (!std::isfinite(value)) fail("{} holds a number that is not finite.", where);
  return value;
}

// Rz(-heading) Rx(pitch) Ry(roll) takes OpenGL's camera axes to a world with z up.
Mat3d rotation_of(double heading, double pitch, double roll) {
  const double d = M_PI / 180;
  const double ch = std::cos(-heading * d), sh = std::sin(-heading * d), cp = std::cos(pitch * d),
               sp = std::sin(pitch * d), cr = std::cos(roll * d), sr = std::sin(roll * d);
  const Mat3d rz{{{ch, -sh, 0}, {sh, ch, 0}, {0, 0, 1}}}, rx{{{1, 0, 0}, {0, cp, -sp}, {0, sp, cp}}},
      ry{{{cr, 0, sr}, {0, 1, 0}, {-sr, 0, cr}}};
  Mat3d m = rz * rx * ry;
  for (Vec3d& row : m.row) row = {row.x, -row.y, -row.z};
  return m;
}

// f is that of a frame 36 units wide, along the longer side; px, py are parts of that side from the middle.
View view_of(const Row& row, const PhotographIndex& photographs, const std::string& where) {
  const std::string& name = row.at("name");
  if (name.empty()) fail("{} has no image name.", where);
  const auto number = [&](const char* column) { return number_in(row, column, where); };
  View view;
  view.name = view_name(with_slashes(name), Split::train);
  view.image_path = photographs.find(name);
  Camera& c = view.camera;
  const ImageSize size = size_of_image(view.image_path);
  c.width = size.width, c.height = size.height;
  const double side = std::max(c.width, c.height);
  c.fx = c.fy = number("f") * side / 36;
  c.cx = c.width / 2.0 + number("px") * side;
  c.cy = c.height / 2.0 + number("py") * side;
  if (size.width > 0 && !(c.fx > 0)) fail("{} has a focal length that is not positive.", where);
  c.world_from_cam = rotation_of(number("heading"), number("pitch"), number("roll"));
  c.center = {number("x"), number("y"), number("alt")};
  const LensDistortion lens{LensKind::perspective,
                            {number("k1"), number("k2"), number("k3"), number("k4")},
                            {},
                            number("t1"),
                            number("t2")};
  if (distorts(lens) && size.width > 0) view.photo = PhotoCamera(c, lens);
  return view;
}

}  // namespace

bool detect_realitycapture(const fs::path& path) { return !csv_of(path).empty(); }

Capture load_realitycapture(const fs::path& path) {
  const fs::path file = csv_of(path);
  const std::vector<std::string> columns = header_of(file);
  Capture capture;
  capture.root = file.parent_path();
  capture.format = "realitycapture";
  const PhotographIndex photographs(capture.root);
  const std::string text = read_file(file);
  Lines lines(text);
  for (lines.next(); lines.next_data();) {
    const std::string where = fmt::format("Line {} of {}", lines.number(), file.string());
    const std::vector<std::string> cells = cells_of(lines.line());
    if (cells.size() < columns.size()) fail("{} has {} of {} columns.", where, cells.size(), columns.size());
    Row row;
    for (size_t i = 0; i < columns.size(); ++i) row[columns[i]] = cells[i];
    capture.views.push_back(view_of(row, photographs, where));
  }
  return capture;
}

}  // namespace cei3d

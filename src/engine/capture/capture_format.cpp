// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/capture_format.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/capture/capture.h"
#include "engine/io/heic_file.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace {

// Replaces bare NaN and Infinity outside strings, which Python writes but JSON does not have, by null.
std::string without_nan(const std::string& text) {
  std::string out;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (in_string && text[i] == '\\' && i + 1 < text.size()) {
      out += text[i++];
    } else if (text[i] == '"') {
      in_string = !in_string;
    } else if (!in_string) {
      size_t n = 0;
      for (const char* word : {"-NaN", "NaN", "-nan", "nan", "-Infinity", "Infinity"})
        if (n == 0 && text.compare(i, std::string_view(word).size(), word) == 0)
          n = std::string_view(word).size();
      if (n > 0) {
        out += "null";
        i += n - 1;
        continue;
      }
    }
    out += text[i];
  }
  return out;
}

}  // namespace

const std::vector<CaptureFormat>& capture_formats() {
  constexpr Vec3d kY{0, 1, 0}, kZ{0, 0, 1};
  static const std::vector<CaptureFormat> formats{
      {"nerf-synthetic", "NeRF-synthetic, nerfstudio, instant-ngp",
       "transforms_{train,val,test}.json or transforms.json", kZ, detect_nerf, load_nerf, nerf_up},
      {"physg", "PhySG", "cam_dict_norm.json, image/, mask/", kY, detect_physg, load_physg},
      {"idr", "IDR, NeuS", "cameras_sphere.npz or cameras.npz, image/, mask/", {}, detect_idr, load_idr},
      {"colmap",
       "COLMAP",
       "sparse/0/{cameras,images,points3D}.bin or .txt, images/",
       {},
       detect_colmap,
       load_colmap},
      {"metashape", "Metashape", "cameras.xml, images/", {}, detect_metashape, load_metashape},
      {"realitycapture", "RealityCapture", "a .csv of internal and external camera parameters, images/", kZ,
       detect_realitycapture, load_realitycapture},
      {"llff", "LLFF", "poses_bounds.npy, images/", {}, detect_llff, load_llff},
      {"meshroom", "Meshroom", "cameras.sfm or sfm.json, images/", {}, detect_meshroom, load_meshroom}};
  return formats;
}

Json read_json_file(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > 32) fail("{} is nested too deep to be a capture.", path.string());
    return true;
  };
  try {
    return Json::parse(without_nan(text), limit_depth);
  } catch (const Json::parse_error& e) {
    fail("{} is not valid JSON (near byte {}). It may be truncated; write it again.", path.string(), e.byte);
  } catch (const Json::out_of_range&) {
    fail("{} has a number that is too large for any file of a capture.", path.string());
  }
}

double number_of(const Json& j, const std::string& where) {
  if (j.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!j.is_number()) fail("{} should be a number.", where);
  return j.get<double>();
}

Matrix34 matrix_of(const Json& j, const std::string& where) {
  const bool nested = j.is_array() && !j.empty() && j[0].is_array();
  const size_t rows = nested ? j.size() : (j.is_array() && j.size() % 4 == 0 ? j.size() / 4 : 0);
  if (rows != 3 && rows != 4) fail("{} should be a 4 x 4 matrix.", where);
  Matrix34 m;
  for (size_t r = 0; r < 3; ++r) {
    if (nested && (!j[r].is_array() || j[r].size() != 4)) fail("{} should be a 4 x 4 matrix.", where);
    for (size_t c = 0; c < 4; ++c) m.m[r][c] = number_of(nested ? j[r][c] : j[4 * r + c], where);
  }
  return m;
}

std::string with_slashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

std::string view_name(const std::string& file_path, Split split) {
  std::filesystem::path name = std::filesystem::path(file_path).lexically_normal();
  if (has_image_suffix(name) || is_heic(name)) name.replace_extension();
  const bool inside = name.is_relative() && !name.empty() && *name.begin() != "..";
  return inside ? name.generic_string() : fmt::format("{}/{}", split_name(split), name.filename().string());
}

std::filesystem::path own_file(const std::filesystem::path& root, const std::filesystem::path& file,
                               const std::string& where) {
  std::filesystem::path home = std::filesystem::absolute(root / ".").lexically_normal().parent_path();
  if (home.parent_path() != home.root_path()) home = home.parent_path();
  const std::filesystem::path normal = file.lexically_normal(),
                              way =
                                  std::filesystem::absolute(file).lexically_normal().lexically_relative(home);
  if (way.empty() || *way.begin() == "..")
    fail(
        "{} names {}, which lies outside of the capture's folder and of the one that holds it. Move that "
        "file into the capture's folder, or a link to it.",
        where, normal.string());
  return normal;
}

std::filesystem::path readable_image(const std::filesystem::path& image) {
  if (!is_heic(image)) return image;
  const std::filesystem::path jpeg = std::filesystem::path(image).replace_extension(".jpg");
  std::error_code error;
  if (!std::filesystem::exists(jpeg, error) && std::filesystem::exists(image, error))
    convert_heic(image, jpeg);
  return jpeg;
}

std::vector<std::filesystem::path> images_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (has_image_suffix(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

ImageSize size_of_image(const std::filesystem::path& path) {
  if (path.empty() || !std::filesystem::exists(path)) return {};
  try {
    return read_image_size(path);
  } catch (const Error&) {
    return {};  // a broken image among good ones: check() reports it with all the others
  }
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/photo_files.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <tuple>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/process.h"
#include "engine/io/heic_file.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

std::string lower_suffix(const fs::path& file) {
  std::string s = file.extension().string();
  for (char& c : s) c = char(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

bool is_photo(const fs::path& file) {
  const std::string s = lower_suffix(file);
  return is_heic(file) || (has_image_suffix(file) && s != ".exr" && s != ".hdr");
}

std::vector<fs::path> photos_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_photo(entry.path())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

// Error: it is not installed, with the package that has it.
ProgramOutput run_tool(const std::vector<std::string>& command, const char* package) {
  try {
    return run_program(command);
  } catch (const Error& e) {
    throw Error(e.code(), e.what(), fmt::format("`apt-get install {}` installs it.", package));
  }
}

[[noreturn]] void fail_reading(const fs::path& file, const char* program, std::string said) {
  while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back()))) said.pop_back();
  fail("{} could not be read. {} said: {}", file.string(), program, said.substr(0, 300));
}

std::string copy_photo(const fs::path& from, const fs::path& to) {
  const fs::path target = to / (is_heic(from) ? from.stem().string() + ".jpg" : from.filename().string());
  if (fs::exists(target)) return target.filename().string();
  if (is_heic(from))
    convert_heic(from, target);
  else
    write_file_atomic(target, read_file(from));
  return target.filename().string();
}

double duration_of(const fs::path& video) {
  const ProgramOutput out = run_tool({"ffprobe", "-v", "error", "-show_entries", "format=duration", "-of",
                                      "default=noprint_wrappers=1:nokey=1", video.string()},
                                     "ffmpeg");
  const double seconds = out.exit_code == 0 ? std::strtod(out.text.c_str(), nullptr) : 0;
  if (!(seconds > 0)) fail_reading(video, "ffprobe", out.text);
  return seconds;
}

void take_frames(const fs::path& video, const fs::path& to, int frames) {
  const fs::path partial = to.parent_path() / "partial-frames";
  fs::remove_all(partial);
  fs::create_directories(partial);
  const ProgramOutput out = run_tool({"ffmpeg", "-v", "error", "-i", video.string(), "-vf",
                                      fmt::format("fps={:.9g}", frames / duration_of(video)), "-q:v", "2",
                                      (partial / "frame_%04d.jpg").string()},
                                     "ffmpeg");
  if (out.exit_code != 0) fail_reading(video, "ffmpeg", out.text);
  move_path(partial, to);
}

// What tells cameras apart: size and focal length.
using CameraNotes = std::tuple<int, int, std::optional<double>>;
CameraNotes notes_of(const fs::path& photo) {
  const ImageSize size = read_image_size(photo);
  return {size.width, size.height, read_image_exif(photo).focal_length};
}

void require_distinct(const std::vector<fs::path>& photos) {
  std::set<std::string> stems;
  for (const fs::path& p : photos)
    if (!stems.insert(p.stem().string()).second)
      fail("There are two photographs named {} in {}: masks and views would have the same name. Rename one.",
           p.stem().string(), p.parent_path().string());
}

}  // namespace

PhotoFiles copy_photos(const fs::path& from, const fs::path& to, int frames, const Progress& progress) {
  PhotoFiles out;
  if (!fs::exists(from)) fail_usage("There is no {}.", from.string());
  out.in_order = fs::is_regular_file(from);
  if (out.in_order) {
    if (!fs::exists(to)) take_frames(from, to, frames);
  } else {
    const std::vector<fs::path> photos = photos_in(from);
    require_distinct(photos);
    if (photos.size() < kMinPhotos)
      throw Error(ErrorCode::failed,
                  fmt::format("{} has {} photographs; an object needs {} at least, better 40.", from.string(),
                              photos.size(), kMinPhotos),
                  "docs/photographing.md says how to take them.");
    for (const fs::path& p : photos) check_cancelled(progress), copy_photo(p, to);
  }
  std::set<CameraNotes> cameras;
  for (const fs::path& p : photos_in(to))
    out.names.push_back(p.filename().string()), cameras.insert(notes_of(p));
  out.one_camera = cameras.size() <= 1;
  return out;
}

}  // namespace cei3d

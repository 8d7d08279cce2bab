// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/colmap_run.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/process.h"
#include "engine/capture/colmap_camera.h"
#include "engine/capture/colmap_model.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// With fewer photographs that have a pose, of all, poses are searched again as on a turntable.
constexpr double kEnoughPosed = 0.9;

using Words = std::vector<std::string>;

// Names of options that COLMAP changed with version 3.13.
struct Dialect {
  std::string extraction = "SiftExtraction", matching = "SiftMatching";
};

Dialect dialect() {
  constexpr const char* kHint =
      "`apt-get install colmap` installs it. Photographs with known cameras need no COLMAP: `cei3d -h` lists "
      "the formats.";
  try {
    const std::string help = run_program({"colmap", "feature_extractor", "-h"}).text;
    if (help.find("FeatureExtraction.use_gpu") != std::string::npos)
      return {"FeatureExtraction", "FeatureMatching"};
    return {};
  } catch (const Error&) {
    throw Error(ErrorCode::failed, "COLMAP, which finds the poses of the photographs, is not installed.",
                kHint);
  }
}

// Intrinsics to begin with, in COLMAP's order.
std::string camera_text(const PosingRequest& r) {
  const ImageSize size = read_image_size(fs::directory_iterator(r.images)->path());
  const double f = *r.focal, cx = size.width / 2.0, cy = size.height / 2.0;
  return fmt::format("{},{},{},0", f, cx, cy);
}

Words feature_step(const PosingRequest& r, const Dialect& d, const std::string& threads) {
  Words w{"feature_extractor", "--database_path", (r.work / "database.db").string(), "--image_path",
          r.images.string(), "--ImageReader.single_camera", r.one_camera ? "1" : "0",
          // Few photographs do not tell more of the lens, and with a wrong one the others do not fit.
          "--ImageReader.camera_model", "SIMPLE_RADIAL", "--" + d.extraction + ".use_gpu", "0",
          "--" + d.extraction + ".num_threads", threads,
          // Without the doubled image of the default, which takes gigabytes; photographs are large enough.
          "--SiftExtraction.first_octave", "0", "--SiftExtraction.max_image_size", "1600",
          "--SiftExtraction.max_num_features", "4096"};
  if (!r.feature_masks.empty()) w.insert(w.end(), {"--ImageReader.mask_path", r.feature_masks.string()});
  if (r.focal) w.insert(w.end(), {"--ImageReader.camera_params", camera_text(r)});
  return w;
}

Words matching_step(const PosingRequest& r, const Dialect& d, const std::string& threads) {
  return {r.in_order ? "sequential_matcher" : "exhaustive_matcher",
          "--database_path",
          (r.work / "database.db").string(),
          "--" + d.matching + ".use_gpu",
          "0",
          "--" + d.matching + ".num_threads",
          threads};
}

// narrow: also from pairs of photographs whose directions differ little, and by few points.
Words mapping_step(const PosingRequest& r, bool narrow, const std::string& threads, const fs::path& models) {
  Words w{"mapper",        "--database_path",      (r.work / "database.db").string(),
          "--image_path",  r.images.string(),      "--output_path",
          models.string(), "--Mapper.num_threads", threads};
  if (narrow)
    w.insert(w.end(), {"--Mapper.init_min_tri_angle", "4", "--Mapper.abs_pose_min_num_inliers", "20"});
  return w;
}

std::string threads_of(const PosingRequest& r) { return std::to_string(r.threads > 0 ? r.threads : -1); }

size_t photos_in(const fs::path& folder) {
  size_t n = 0;
  for (const auto& entry : fs::directory_iterator(folder)) n += entry.is_regular_file();
  return n;
}

std::string tail_of(const fs::path& file, uintmax_t from) {
  std::string text = read_file(file);
  text.erase(0, std::min<size_t>(size_t(from), text.size()));
  return text;
}

class Steps {
 public:
  Steps(const PosingRequest& r, Progress& progress)
      : log_(r.work / "colmap.log"), photos_(photos_in(r.images)), progress_(progress) {}

  // Runs one step and shows its progress from `first` to `last`.
  void run(const char* stage, Words words, double first, double last) {
    words.insert(words.begin(), {"env", "QT_QPA_PLATFORM=offscreen", "colmap"});
    std::error_code none;
    const uintmax_t begin = fs::exists(log_) ? fs::file_size(log_, none) : 0;
    Child child(words, log_);
    while (!child.exit_code()) {
      if (progress_.cancelled()) child.ask_to_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      const double share = colmap_progress(tail_of(log_, begin), photos_).value_or(0);
      progress_.report({stage, first + (last - first) * share, -1, ""});
    }
    check_cancelled(progress_, "Interrupted; the same command goes on from here.");
    if (*child.exit_code() == 0) return;
    const std::string said = tail_of(log_, begin);
    throw Error(ErrorCode::failed, fmt::format("COLMAP's {} failed.", words[3]),
                fmt::format("{} says why. Its end: {}", log_.string(),
                            said.substr(said.size() - std::min<size_t>(said.size(), 300))));
  }

  // Likewise; whether COLMAP did not fail.
  bool succeeds(const char* stage, Words words, double first, double last) {
    try {
      run(stage, std::move(words), first, last);
    } catch (const Error& e) {
      if (e.code() != ErrorCode::failed) throw;
      return false;
    }
    return true;
  }

 private:
  fs::path log_;
  size_t photos_;
  Progress& progress_;
};

// Finds poses in `folder`. Returns how many the largest of the models has; 0: there is none.
size_t map_photos(Steps& steps, const PosingRequest& r, bool narrow, const fs::path& folder, double first,
                  double last) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  // Some versions of COLMAP fail where they find nothing.
  steps.succeeds("poses", mapping_step(r, narrow, threads_of(r), folder), first, last);
  size_t most = 0;
  for (const auto& model : fs::directory_iterator(folder))
    if (is_colmap_model(model)) most = std::max(most, colmap_image_count(model));
  return most;
}

// Adjusts each model again with more of the lens, which all its photographs together tell.
void refine_lens(Steps& steps, const fs::path& models, const fs::path& work, double progress) {
  const std::vector<fs::path> folders(fs::directory_iterator(models), {});
  for (const fs::path& model : folders) {
    if (!give_full_lens(model)) continue;
    const fs::path refined = work / "refined";
    fs::remove_all(refined);
    fs::create_directories(refined);
    const Words step{"bundle_adjuster", "--input_path", model.string(), "--output_path", refined.string()};
    if (!steps.succeeds("poses", step, progress, progress)) continue;
    fs::remove_all(model);
    move_path(refined, model);
  }
}

}  // namespace

bool give_full_lens(const fs::path& model) {
  struct Head {
    uint64_t cameras;
    uint32_t id;
    int32_t kind;
    uint64_t width, height;
  } head;
  std::array<double, 4> k{};  // f, cx, cy, k1
  const fs::path file = model / "cameras.bin";
  const std::string bytes = fs::exists(file) ? read_file(file) : "";
  if (bytes.size() != sizeof head + sizeof k) return false;
  std::memcpy(&head, bytes.data(), sizeof head);
  std::memcpy(k.data(), bytes.data() + sizeof head, sizeof k);
  if (head.cameras != 1 || head.kind != colmap_camera_model("SIMPLE_RADIAL", "").id) return false;
  head.kind = colmap_camera_model("OPENCV", "").id;
  std::string full;
  append_bytes(full, head);
  append_bytes(full, std::array<double, 8>{k[0], k[0], k[1], k[2], k[3], 0, 0, 0});
  write_file_atomic(file, full);
  return true;
}

void require_colmap() { dialect(); }

bool poses_are_found(const PosingRequest& r) {
  std::error_code none;
  return fs::exists(r.sparse / "0", none);
}

std::optional<double> colmap_progress(const std::string& log, size_t photos) {
  unsigned done = 0, all = 0, other = 0, others = 0;
  // The last line of each kind; a step prints one kind only.
  if (const size_t p = log.rfind("Processed file ["); p != std::string::npos)
    if (std::sscanf(log.c_str() + p, "Processed file [%u/%u]", &done, &all) == 2 && all > 0)
      return double(done) / all;
  if (const size_t p = log.rfind("Matching block ["); p != std::string::npos)
    if (std::sscanf(log.c_str() + p, "Matching block [%u/%u, %u/%u]", &done, &all, &other, &others) == 4 &&
        all > 0 && others > 0)
      return (double(done - 1) * others + other - 1) / (double(all) * others);
  if (const size_t p = log.rfind("Matching image ["); p != std::string::npos)
    if (std::sscanf(log.c_str() + p, "Matching image [%u/%u]", &done, &all) == 2 && all > 0)
      return double(done) / all;
  if (const size_t p = log.rfind("Registering image #"); p != std::string::npos)
    if (std::sscanf(log.c_str() + p, "Registering image #%u (%u)", &other, &done) == 2 && photos > 0)
      return std::min(1.0, double(done) / double(photos));
  return std::nullopt;
}

void find_poses(const PosingRequest& r, double first, double last, Progress& progress) {
  if (poses_are_found(r)) return;
  const Dialect d = dialect();
  fs::create_directories(r.work);
  const auto at = [&](double share) { return first + (last - first) * share; };
  Steps steps(r, progress);
  steps.run("features", feature_step(r, d, threads_of(r)), at(0), at(0.15));
  steps.run("matches", matching_step(r, d, threads_of(r)), at(0.15), at(0.6));
  const fs::path wide = r.work / "models", narrow = r.work / "narrow_models";
  const size_t of_wide = r.turntable ? 0 : map_photos(steps, r, false, wide, at(0.6), at(0.8));
  const bool enough = double(of_wide) >= kEnoughPosed * double(photos_in(r.images));
  const size_t of_narrow = enough ? 0 : map_photos(steps, r, true, narrow, at(0.8), at(1));
  if (of_wide + of_narrow == 0)
    throw Error(
        ErrorCode::failed, "COLMAP could not find out from where the photographs were taken.",
        fmt::format("Photographs of the same places that overlap by half, sharp, of a surface with texture, "
                    "help: docs/photographing.md. COLMAP's own words are in {}.",
                    (r.work / "colmap.log").string()));
  const fs::path& best = of_narrow > of_wide ? narrow : wide;
  refine_lens(steps, best, r.work, at(1));
  fs::remove_all(r.sparse);
  move_path(best, r.sparse);
}

}  // namespace cei3d

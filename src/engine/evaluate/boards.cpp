// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/base/json.h"
#include "core/image/resample.h"
#include "engine/evaluate/evaluation_set.h"
#include "engine/io/image_file.h"
#include "engine/session/frame_files.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr size_t kViews = 5;  // number of views of an object, as in the paper's study

// The n-th of equal columns.
Image column(const Image& row, int n, int columns) {
  const int width = row.width / columns;
  return cropped(row, {n * width, 0, width, row.height});
}

Image opaque(const Image& rgb) {
  Image out(rgb.width, rgb.height, 4, 1);
  for (size_t i = 0; i < size_t(rgb.width) * rgb.height; ++i)
    for (size_t c = 0; c < 3; ++c) out.data[4 * i + c] = rgb.data[size_t(rgb.channels) * i + c];
  return out;
}

// The painted object in the picture of a row: photograph, before, after.
Image edited_picture(const fs::path& report, const std::string& row, const std::string& view) {
  return opaque(column(read_image(report / "pictures" / row / (view + ".png")), 2, 3));
}

}  // namespace

void write_boards(const EvaluationSetReport& set, const fs::path& out) {
  Json key = Json::object();
  for (const EvaluatedCapture& capture : set.captures) {
    if (capture.reports.empty() || capture.reports.front().paint.empty()) continue;
    const EvaluationReport& report = capture.reports.front();
    const std::vector<ViewScore>& views = report.object.scores.views;
    for (size_t k = 0; k < std::min(kViews, views.size()); ++k) {
      const std::string view =
          fs::path(views[k * views.size() / std::min(kViews, views.size())].view).filename().string();
      const std::string board = fmt::format("{}-{}", capture.name, view);
      std::vector<std::pair<std::string, std::string>> order;  // by a hash of board and method
      for (const EvaluationRow& row : report.paint)
        if (row.skipped.empty()) order.push_back({content_hash(board + row.name), row.name});
      std::sort(order.begin(), order.end());
      std::vector<Image> pictures;
      for (const auto& [hash, row] : order) {
        pictures.push_back(edited_picture(report.folder, row, view));
        key[board].push_back(row);
      }
      write_png(out / "boards" / (board + ".png"), side_by_side(pictures));
    }
  }
  write_file_atomic(out / "boards" / "key.json", key.dump(1) + "\n");
}

}  // namespace cei3d

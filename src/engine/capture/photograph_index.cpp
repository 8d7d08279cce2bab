// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/photograph_index.h"

#include <algorithm>
#include <vector>

#include "engine/capture/capture_format.h"
#include "engine/io/heic_file.h"
#include "engine/io/image_file.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr int kDepth = 4;

fs::path without_suffix(fs::path path) {
  if (has_image_suffix(path) || is_heic(path)) path.replace_extension();
  return path;
}

// Number of last parts that two paths share, without suffixes.
int common_end(const fs::path& a, const fs::path& b) {
  const fs::path x = without_suffix(a), y = without_suffix(b);
  const std::vector<fs::path> p(x.begin(), x.end()), q(y.begin(), y.end());
  int n = 0;
  while (n < int(std::min(p.size(), q.size())) && p[p.size() - 1 - size_t(n)] == q[q.size() - 1 - size_t(n)])
    ++n;
  return n;
}

}  // namespace

PhotographIndex::PhotographIndex(const fs::path& root) : root_(root) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator it(root, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (it->is_directory(error)) {
      if (name == "mask" || name == "masks" || it.depth() >= kDepth) it.disable_recursion_pending();
    } else if ((has_image_suffix(it->path()) || is_heic(it->path())) &&
               it->path().stem().extension() != ".mask") {
      files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) by_stem_.emplace(file.stem().string(), file);
}

fs::path PhotographIndex::find(const std::string& name) const {
  const fs::path wanted = fs::path(with_slashes(name)).lexically_normal();
  const fs::path* best = nullptr;
  int longest = 0;
  for (const std::string& stem : {without_suffix(wanted).filename().string(), wanted.filename().string()}) {
    const auto [first, last] = by_stem_.equal_range(stem);
    for (auto it = first; it != last; ++it)
      if (const int n = common_end(it->second, wanted); !best || n > longest) best = &it->second, longest = n;
  }
  return best ? readable_image(*best) : root_ / "images" / wanted.filename();
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/find_masks.h"

#include <string>
#include <vector>

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// Names that need no folder of their own first.
std::vector<std::string> names_beside(const fs::path& image) {
  const std::string stem = image.stem().string(), name = image.filename().string();
  return {stem + ".mask.png", name + ".mask.png", stem + "_mask.png", name + "_mask.png",
          "dynamic_mask_" + stem + ".png"};
}

std::vector<std::string> names_in_folder(const fs::path& image) {
  const std::string stem = image.stem().string(), name = image.filename().string();
  std::vector<std::string> names{name + ".png", stem + ".png",  stem + ".PNG",
                                 stem + ".jpg", stem + ".jpeg", name};
  for (const std::string& n : names_beside(image)) names.push_back(n);
  return names;
}

fs::path first_of(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return {};
  for (const std::string& name : names)
    if (fs::is_regular_file(folder / name, error)) return folder / name;
  return {};
}

}  // namespace

fs::path find_mask(const fs::path& root, const fs::path& image) {
  if (const fs::path beside = first_of(image.parent_path(), names_beside(image)); !beside.empty())
    return beside;
  const fs::path folder = image.parent_path(), inside = folder.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..") return {};
  // images/a/b.jpg: the masks of a/b.jpg lie in masks/a, masks, images/masks or images/a/masks.
  fs::path below;
  for (auto part = inside.begin(); part != inside.end(); ++part)
    if (part != inside.begin()) below /= *part;
  const std::vector<std::string> names = names_in_folder(image);
  for (const char* masks : {"masks", "mask"})
    for (const fs::path& place : {root / masks / inside, root / masks / below, root / masks, folder / masks,
                                  folder.parent_path() / masks, root / *inside.begin() / masks / below})
      if (place != folder)
        if (const fs::path found = first_of(place, names); !found.empty()) return found;
  return {};
}

}  // namespace cei3d

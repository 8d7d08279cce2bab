// SPDX-License-Identifier: Apache-2.0
#include "engine/io/heic_file.h"

#include <cctype>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/process.h"
#include "core/base/temp_folder.h"

namespace cei3d {

bool is_heic(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = char(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".heic" || suffix == ".heif";
}

void convert_heic(const std::filesystem::path& from, const std::filesystem::path& to) {
  const TempFolder temp;
  const std::filesystem::path made = temp.path() / "image.jpg";
  ProgramOutput out;
  try {
    out = run_program({"heif-convert", "-q", "95", from.string(), made.string()});
  } catch (const Error& e) {
    throw Error(e.code(), e.what(), "`apt-get install libheif-examples` installs it.");
  }
  if (out.exit_code != 0 || !std::filesystem::exists(made))
    fail("{} could not be read. heif-convert said: {}", from.string(), out.text.substr(0, 300));
  write_file_atomic(to, read_file(made));
}

}  // namespace cei3d

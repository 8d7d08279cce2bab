// SPDX-License-Identifier: Apache-2.0
#include "engine/io/zip_file.h"

#include <zip.h>

#include <memory>

#include "core/base/error.h"

namespace cei3d {
namespace {

struct Discard {
  void operator()(zip_t* p) const { zip_discard(p); }
  void operator()(zip_file_t* p) const { zip_fclose(p); }
};
using Archive = std::unique_ptr<zip_t, Discard>;

[[noreturn]] void broken(const std::string& name, const std::string& why) {
  fail("{} is not a usable ZIP archive: {}. Copy or write it again.", name, why);
}

struct ErrorText {
  zip_error_t error;
  ErrorText() { zip_error_init(&error); }
  ~ErrorText() { zip_error_fini(&error); }
  ErrorText(const ErrorText&) = delete;
  ErrorText& operator=(const ErrorText&) = delete;
  std::string text() { return zip_error_strerror(&error); }
};

// Reads from `bytes`, without a copy.
Archive open(const std::string& bytes, const std::string& name) {
  ErrorText e;
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &e.error);
  if (!source) broken(name, e.text());
  Archive archive(zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &e.error));
  if (!archive) {
    zip_source_free(source);
    broken(name, e.text());
  }
  return archive;
}

std::string read_entry(zip_t* archive, uint64_t i, uint64_t size, const std::string& name) {
  const std::unique_ptr<zip_file_t, Discard> file(zip_fopen_index(archive, i, 0));
  if (!file) broken(name, zip_strerror(archive));
  std::string bytes(size, '\0');
  const zip_int64_t n = zip_fread(file.get(), bytes.data(), size);
  char more;  // asking for the byte behind the last is what makes libzip compare the checksum
  if (n != zip_int64_t(size) || zip_fread(file.get(), &more, 1) != 0)
    broken(name, fmt::format("its entry {} is damaged", i));
  return bytes;
}

}  // namespace

std::map<std::string, std::string> unzip(const std::string& bytes, const std::string& name,
                                         uint64_t max_bytes) {
  if (bytes.empty()) broken(name, "it is empty");  // which libzip takes for an archive of nothing
  const Archive archive = open(bytes, name);
  std::map<std::string, std::string> files;
  uint64_t left = max_bytes;
  const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
  for (uint64_t i = 0; i < uint64_t(std::max<zip_int64_t>(entries, 0)); ++i) {
    zip_stat_t stat;
    if (zip_stat_index(archive.get(), i, 0, &stat) != 0) broken(name, zip_strerror(archive.get()));
    if (!(stat.valid & ZIP_STAT_NAME) || !(stat.valid & ZIP_STAT_SIZE))
      broken(name, fmt::format("its entry {} has no name or size", i));
    if (stat.size > left)
      fail("{} unpacks to more than {} MiB, which is more than cameras need.", name, max_bytes >> 20);
    left -= stat.size;
    files[stat.name] = read_entry(archive.get(), i, stat.size, name);
  }
  return files;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: what the page of the editor sends, and lists that users write: manifests, cameras,
// settings. The first byte of the input chooses what the rest is. Anything but a request or an Error is a
// finding.
#include <string>

#include "apps/server/edit_json.h"
#include "apps/server/guard.h"
#include "apps/server/http.h"
#include "apps/server/uploads.h"
#include "core/base/file.h"
#include "core/base/parse_json.h"
#include "core/base/settings.h"
#include "core/base/temp_folder.h"
#include "engine/batch/manifest.h"
#include "engine/batch/state.h"
#include "engine/session/cameras.h"
#include "tests/fuzz/target.h"

namespace {
using namespace cei3d;

// {"op": ..., "params": {...}}, and a frame, as the editor reads them.
void read_request(const std::string& bytes, bool frame) {
  static Uploads uploads;
  static const std::string scribble = uploads.add("scribble.png", "scribble");
  const Json j = parse_json(bytes);
  JsonReader reader(j, "The request");
  if (frame)
    frame_request(reader, uploads);
  else
    edit_command(reader.require<std::string>("op"), reader.member("params"), uploads);
  reader.finish();
}

// A head as the network hands it over: path, query, host, origin and token, a line each.
void read_head(const std::string& bytes) {
  static const Guard guard("0123456789abcdef");
  HttpRequest r;
  size_t at = 0;
  for (std::string* field : {&r.method, &r.path, &r.query, &r.host, &r.origin, &r.authorization}) {
    const size_t end = std::min(bytes.find('\n', at), bytes.size());
    *field = bytes.substr(std::min(at, bytes.size()), end - std::min(at, bytes.size()));
    at = end + 1;
  }
  guard.refuse(r);
  decoded(r.path);
  r.parameter("name");
  plain_file_name(r.query);
}

void read_manifest(const std::filesystem::path& file) {
  const BatchManifest manifest = BatchManifest::read(file);
  const BatchCatalog catalog(file.parent_path() / "catalog");
  for (size_t i = 0; i < manifest.size(); ++i) catalog.item(manifest, i);
}

void read_settings(const std::filesystem::path& file) {
  static const SettingInfo known[] = {{.key = "steps", .kind = SettingInfo::Kind::whole, .max = 9},
                                      {.key = "shape", .kind = SettingInfo::Kind::choice, .choices = {"a"}}};
  Json values = Json::object();
  add_setting(known, "@" + file.string(), values);
}

void read_as(int kind, const std::string& bytes) {
  static const TempFolder temp;
  static const char* const kFiles[] = {"m.jsonl",       "m.csv",      "cameras.json",
                                       "settings.json", "state.json", "catalog/batch.json"};
  if (kind < 2) return read_request(bytes, kind == 1);
  if (kind == 2) return read_head(bytes);
  const std::filesystem::path file = temp.path() / kFiles[kind - 3];
  write_file_atomic(file, bytes);
  if (kind == 3 || kind == 4) return read_manifest(file);
  if (kind == 5) return void(read_camera(file));
  if (kind == 6) return read_settings(file);
  if (kind == 7) return void(read_batch_state(temp.path()));
  BatchCatalog catalog(file.parent_path());
  std::filesystem::remove(file);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzz_kinds(data, size, 9, read_as);
}

// SPDX-License-Identifier: Apache-2.0
// What the page exports is what the commands `export` and `render --turntable` write.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/server/test_editor.h"
#include "core/base/file.h"
#include "engine/io/zip_file.h"

namespace cei3d {
namespace {

class ExportTest : public EditorTest {
 protected:
  std::string exported(const Json& request, const std::string& route = "/api/export") {
    const HttpResponse r = post(route, request);
    EXPECT_EQ(r.status, 200) << r.body;
    const std::string name = Json::parse(r.body)["files"].back()["name"];
    const HttpResponse file = get("/api/download/" + name);
    EXPECT_EQ(file.status, 200);
    EXPECT_EQ(file.body, read_file(folder() / "exports" / name));
    return file.body;
  }
  // The file that a Session writes, without the editor, which is closed before.
  std::string written(ExportRequest request) {
    editor_.reset();
    Session session("cpu", 2);
    Progress quiet;
    session.open(folder(), Session::Access::read);
    const std::filesystem::path file = temp_.path() / "alone" / request.out.front();
    request.out = {file};
    session.export_to(request, quiet);
    return read_file(file);
  }
};

TEST_F(ExportTest, ReadsWhatTheCommandReads) {
  const std::string by_page = exported({{"file", "ball.glb"},
                                        {"for", "ar"},
                                        {"faces", 300},
                                        {"texture", 64},
                                        {"image", "png"},
                                        {"origin", "input"},
                                        {"size", 0.3}});
  ExportRequest same;
  same.out = {"ball.glb"};
  same.purpose = ExportFor::ar;
  same.faces = 300;
  same.texture = 64;
  same.image = ExportImage::png;
  same.at_base = false;
  same.size = 0.3;
  EXPECT_EQ(by_page, written(same));
}

TEST_F(ExportTest, EachOptionCounts) {
  const Json least = {{"file", "ball.glb"}, {"faces", 300}, {"texture", 64}};
  std::vector<std::string> all = {exported(least)};
  for (const Json& more : {Json{{"for", "web"}},
                           {{"image", "webp"}},
                           {{"origin", "base"}},
                           {{"unit_scale", 2}},
                           {{"size", 0.3}}}) {
    Json request = least;
    request.update(more);
    all.push_back(exported(request));
  }
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = 0; k < i; ++k) EXPECT_NE(all[i], all[k]) << i << " " << k;
}

TEST_F(ExportTest, ATurntableIsThatOfTheCommand) {
  const std::string archive =
      exported({{"file", "../ball-turntable.zip"}, {"turntable", 3}, {"samples", 1}, {"size", {24, 20}}},
               "/api/turntable");
  editor_.reset();
  Session session("cpu", 2);
  Progress quiet;
  session.open(folder(), Session::Access::read);
  RenderRequest request;
  request.out = temp_.path() / "frames";
  request.cameras = Turntable{3};
  request.samples = 1;
  request.width = 24;
  request.height = 20;
  session.render(request, quiet);
  const auto frames = unzip(archive, "turntable", 1 << 24);
  ASSERT_EQ(frames.size(), 3u);
  for (const auto& [name, bytes] : frames) EXPECT_EQ(bytes, read_file(request.out / "rgb" / name)) << name;
}

TEST_F(ExportTest, WhatCannotBeExportedIsASentence) {
  const std::pair<const char*, Json> bad[] = {
      {"export", {{"for", "vr"}}},
      {"export", {{"image", "gif"}}},
      {"export", {{"origin", "top"}}},
      {"export", {{"size", -1}}},
      {"export", {{"size", 1}, {"unit_scale", 1}}},
      {"export", {{"texture", 7}}},
      {"turntable", {{"turntable", 3}}},  // not a .zip
      {"turntable", {{"file", "x.zip"}, {"turntable", 0}}},
      {"turntable", {{"file", "x.zip"}, {"turntable", 3}, {"size", {0, 9}}}},
      {"turntable", {{"file", "x.zip"}, {"turntable", 3}, {"samples", 9}}}};
  for (const auto& [route, more] : bad) {
    Json body = {{"file", "ball.glb"}};
    body.update(more);
    const HttpResponse r = post(std::string("/api/") + route, body);
    EXPECT_EQ(r.status, 400) << body << r.body;
    EXPECT_FALSE(Json::parse(r.body)["error"].get<std::string>().empty());
  }
  EXPECT_FALSE(std::filesystem::exists(folder() / "exports"));
  start(true);
  EXPECT_EQ(post("/api/turntable", {{"file", "x.zip"}, {"turntable", 3}}).status, 400);
  EXPECT_FALSE(std::filesystem::exists(folder() / "exports"));
}

}  // namespace
}  // namespace cei3d

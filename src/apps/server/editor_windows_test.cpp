// SPDX-License-Identifier: Apache-2.0
// What the windows of the editor are sent: packs, frames, and the messages that all of them get.
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "apps/server/test_editor.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

TEST_F(EditorTest, APageStartsWithOneRequest) {
  const Json start = Json::parse(get("/api/start").body);
  EXPECT_EQ(start["state"], state());
  EXPECT_EQ(start["object"], Json::parse(get("/api/object").body));
}

// Packs that a window asks for before it has had a frame are sent after the first frame, or, if it asks for
// no frame, when all packs are made.
TEST_F(EditorTest, PacksArriveWithAndWithoutAFrame) {
  get("/api/pack/vertex_light");  // this stores the light in a file, so that the first frame is quick
  for (const bool looks : {false, true}) {
    editor_.reset();
    EditorOptions options;
    options.path = folder();
    options.device = "cpu";
    options.threads = 2;
    editor_ = std::make_unique<Editor>(options, Guard(kTestToken));
    const auto socket = std::make_shared<FakeSocket>();
    editor_->opened(socket);
    editor_->received(socket, Json{{"type", "hello"}, {"token", kTestToken}}.dump());
    while (state()["mode"] != "project") std::this_thread::yield();
    if (looks) editor_->received(socket, Json{{"type", "view"}, {"seq", 1}, {"camera", camera(0)}}.dump());
    for (const char* kind : {"shape", "look", "light"})
      EXPECT_EQ(get(std::string("/api/pack/") + kind).status, 200);
    editor_->wait_until_idle();
    EXPECT_EQ(socket->count("frame"), looks ? 1u : 0u);
  }
}

TEST_F(EditorTest, OnlyThePackOfTheCurrentKeyMayBeCached) {
  const Json keys = state()["packs"];
  const auto pack = [&](const std::string& key) {
    HttpRequest r;
    r.method = "GET";
    r.path = "/api/pack/look";
    r.query = "key=" + key;
    return ask(std::move(r));
  };
  const HttpResponse before = pack(keys["look"]);
  EXPECT_EQ(before.headers.size(), 1u);  // Cache-Control: the browser may keep it
  post("/api/edit", {{"op", "material"}, {"params", {{"roughness", 0.9}}}});
  EXPECT_NE(state()["packs"]["look"], keys["look"]);
  const HttpResponse now = pack(state()["packs"]["look"]), late = pack(keys["look"]);
  EXPECT_EQ(now.headers.size(), 1u);
  EXPECT_TRUE(late.headers.empty());  // the look of that key is gone
  EXPECT_TRUE(late.body == now.body && late.body != before.body);
  EXPECT_EQ(get("/api/pack/color").status, 400);
}

TEST_F(EditorTest, ASlowConnectionGetsPacksThatAreCompressed) {
  HttpRequest r;
  r.method = "GET";
  r.path = "/api/pack/shape";
  const HttpResponse plain = ask(r);
  r.query = "packed=1";
  const HttpResponse packed = ask(r);
  EXPECT_TRUE(std::any_of(packed.headers.begin(), packed.headers.end(), [](const auto& h) {
    return h == std::pair<std::string, std::string>("Content-Encoding", "gzip");
  }));
  EXPECT_EQ(packed.body.substr(0, 2), "\x1f\x8b");
  EXPECT_LT(packed.body.size(), 0.8 * double(plain.body.size()));
  // The last four bytes of a gzip file are the size of its uncompressed content.
  const auto* end = reinterpret_cast<const unsigned char*>(packed.body.data() + packed.body.size() - 4);
  EXPECT_EQ(end[0] + (end[1] << 8) + (end[2] << 16) + (size_t(end[3]) << 24), plain.body.size());
}

TEST_F(EditorTest, AWindowGetsItsFrameInTilesAndIsToldOfChanges) {
  const auto socket = std::make_shared<FakeSocket>();
  editor_->opened(socket);
  editor_->received(socket, Json{{"type", "hello"}, {"token", kTestToken}}.dump());
  EXPECT_EQ(socket->count("welcome"), 1u);
  editor_->received(socket, Json{{"type", "view"}, {"seq", 7}, {"camera", camera(0)}, {"samples", 2}}.dump());
  editor_->wait_until_idle();
  ASSERT_EQ(socket->count("frame"), 1u);
  ASSERT_EQ(socket->pictures.size(), 1u);
  const std::string& bytes = socket->pictures[0];
  const size_t head = size_t((unsigned char)bytes[0]) + 256 * size_t((unsigned char)bytes[1]);
  EXPECT_EQ(Json::parse(bytes.substr(4, head))["seq"], 7);
  EXPECT_EQ(bytes.size(), 4 + head + 4 * kSize * kSize);
  EXPECT_EQ((unsigned char)bytes[4 + head + 4 * (24 * kSize + 24) + 3], 255);  // the ball is opaque
  post("/api/edit", {{"op", "material"}, {"params", {{"roughness", 0.3}}}});
  EXPECT_EQ(socket->count("state"), 2u);  // the first with the welcome
  editor_->received(socket, "{\"type\": \"view\"}");
  EXPECT_EQ(socket->count("error"), 1u);
  editor_->closed(socket);
}

// A window that has said hello. before: for a window that was connected before, the run of the program and
// the number of the last message that it got.
std::shared_ptr<FakeSocket> window(Editor& editor, const Json& before = Json::object()) {
  const auto socket = std::make_shared<FakeSocket>();
  Json hello = {{"type", "hello"}, {"token", kTestToken}};
  hello.update(before);
  editor.opened(socket);
  editor.received(socket, hello.dump());
  return socket;
}

Json last_news(const FakeSocket& socket, const Json& run) {
  return {{"run", run}, {"after", socket.texts.back()["event"]}};
}

TEST_F(EditorTest, AWindowThatWasAwayGetsWhatItMissed) {
  const auto there = window(*editor_), leaves = window(*editor_);
  const Json run = leaves->texts[0]["run"];
  EXPECT_EQ(leaves->texts[0]["complete"], false);
  EXPECT_EQ(leaves->texts[1]["type"], "state");
  post("/api/edit", {{"op", "material"}, {"params", {{"roughness", 0.3}}}});
  editor_->closed(leaves);
  for (const double scale : {2.0, 3.0}) post("/api/edit", {{"op", "light"}, {"params", {{"scale", scale}}}});
  const auto back = window(*editor_, last_news(*leaves, run));
  EXPECT_EQ(back->texts[0]["complete"], true);
  std::vector<Json> all = leaves->texts, others = there->texts;
  all.insert(all.end(), back->texts.begin() + 1, back->texts.end());
  EXPECT_EQ(std::vector<Json>(all.begin() + 2, all.end()),
            std::vector<Json>(others.begin() + 2, others.end()));
  EXPECT_GE(back->texts.size(), 3u);
  EXPECT_EQ(window(*editor_, last_news(*back, run))->texts.size(), 1u);  // nothing was missed
  EXPECT_EQ(window(*editor_, last_news(*back, "another"))->texts[0]["complete"], false);
  for (const Json& after : {Json(-1), Json("x"), Json(1e30)})
    EXPECT_TRUE(window(*editor_, {{"run", run}, {"after", after}})->closed) << after;
}

TEST_F(EditorTest, AWindowThatWasAwayForLongGetsTheState) {
  start(false, 2);
  const auto leaves = window(*editor_);
  const Json run = leaves->texts[0]["run"];
  post("/api/edit", {{"op", "light"}, {"params", {{"scale", 2}}}});
  editor_->closed(leaves);
  for (int i = 0; i < 3; ++i)
    post("/api/edit", {{"op", "light"}, {"params", {{"scale", 3}}}, {"amend", true}});
  const auto back = window(*editor_, last_news(*leaves, run));
  EXPECT_EQ(back->texts[0]["complete"], false);
  ASSERT_EQ(back->texts.size(), 2u);
  EXPECT_EQ(back->texts[1]["revision"], state()["revision"]);
}

TEST_F(EditorTest, AWindowWithoutTheKeyOrThatSaysMoreIsClosed) {
  const std::string with_more = Json{{"type", "hello"}, {"token", kTestToken}, {"after_all", 1}}.dump();
  for (const char* first : {R"({"type": "hello", "token": "0123456789abcdee"})", R"({"type": "hello"})",
                            R"({"type": "view", "seq": 1})", "nonsense", with_more.c_str()}) {
    const auto socket = std::make_shared<FakeSocket>();
    editor_->opened(socket);
    editor_->received(socket, first);
    EXPECT_TRUE(socket->closed) << first;
    editor_->closed(socket);
  }
}

TEST_F(EditorTest, AMessageWithAnUnknownKeyIsAnError) {
  const auto at = window(*editor_);
  for (const Json& message :
       {Json{{"type", "rest"}, {"now", true}}, Json{{"type", "view"}, {"sequence", 1}}}) {
    const size_t before = at->texts.size();
    editor_->received(at, message.dump());
    ASSERT_EQ(at->texts.size(), before + 1) << message;
    EXPECT_EQ(at->texts.back()["type"], "error") << message;
  }
  editor_->closed(at);
}

}  // namespace
}  // namespace cei3d

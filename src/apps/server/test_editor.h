// SPDX-License-Identifier: Apache-2.0
// For tests: an editor of a project that holds a sphere. Requests are made without a network.
#pragma once

#include <gtest/gtest.h>

#include <future>

#include "apps/server/editor.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/session/test_edits.h"

namespace cei3d {

inline constexpr const char* kTestToken = "0123456789abcdef";

class EditorTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Project::create(folder(), {}, three_views(), false).save_base(sphere_with_handlers());
    start();
  }
  std::filesystem::path folder() const { return temp_.path() / "ball"; }
  void start(bool read_only = false, size_t news_kept = 1000) {
    editor_.reset();
    EditorOptions options;
    options.path = folder();
    options.read_only = read_only;
    options.device = "cpu";
    options.threads = 2;
    options.news_kept = news_kept;
    editor_ = std::make_unique<Editor>(options, Guard(kTestToken));
    editor_->wait_until_idle();
  }

  HttpResponse ask(HttpRequest r) {
    std::promise<HttpResponse> promise;
    auto future = promise.get_future();
    editor_->answer(std::move(r), [&](HttpResponse response) { promise.set_value(std::move(response)); });
    return future.get();
  }
  HttpResponse get(const std::string& path) {
    HttpRequest r;
    r.method = "GET";
    r.path = path;
    return ask(std::move(r));
  }
  HttpResponse post(const std::string& path, const Json& body, const std::string& if_match = {}) {
    HttpRequest r;
    r.method = "POST";
    r.path = path;
    r.if_match = if_match;
    r.body = body.dump();
    return ask(std::move(r));
  }
  std::string upload(const std::string& bytes) {
    HttpRequest r;
    r.method = "POST";
    r.path = "/api/upload";
    r.query = "name=file.png";
    r.body = bytes;
    return Json::parse(ask(std::move(r)).body)["id"];
  }
  Json state() { return Json::parse(get("/api/state").body); }
  Json camera(int view) { return Json::parse(get("/api/object").body)["views"][size_t(view)]["camera"]; }

  TempFolder temp_;
  std::unique_ptr<Editor> editor_;
};

// Keeps what a window would have received.
class FakeSocket : public Socket {
 public:
  void send(std::string text) override {
    const std::lock_guard lock(mutex_);
    texts.push_back(Json::parse(text));
  }
  void send_picture(std::string bytes, uint64_t) override {
    const std::lock_guard lock(mutex_);
    pictures.push_back(std::move(bytes));
  }
  void close() override { closed = true; }
  size_t count(const std::string& type) {
    const std::lock_guard lock(mutex_);
    size_t n = 0;
    for (const Json& j : texts) n += j["type"] == type;
    return n;
  }

  std::vector<Json> texts;
  std::vector<std::string> pictures;
  std::atomic<bool> closed = false;

 private:
  std::mutex mutex_;
};

}  // namespace cei3d

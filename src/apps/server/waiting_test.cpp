// SPDX-License-Identifier: Apache-2.0
// The number of requests that wait for the worker is limited.
#include "apps/server/test_editor.h"

namespace cei3d {
namespace {

class WaitingTest : public EditorTest {
 protected:
  void send(const std::string& method, const std::string& path, const Json& body,
            std::function<void(HttpResponse)> reply) {
    HttpRequest r;
    r.method = method;
    r.path = path;
    if (method == "POST") r.body = body.dump();
    editor_->answer(std::move(r), std::move(reply));
  }
  // The status of the reply; 0: there is no reply yet, because the request waits.
  int status_now(const std::string& method, const std::string& path, const Json& body = {}) {
    const auto status = std::make_shared<std::atomic<int>>(0);
    send(method, path, body, [status](HttpResponse r) { *status = r.status; });
    return *status;
  }
};

TEST_F(WaitingTest, TooMuchIsRefused) {
  const Json pick = {{"camera", camera(0)}, {"pixel", {24, 24}}};
  const Json rough = {{"op", "material"}, {"params", {{"roughness", 0.3}}}};
  std::promise<void> begun, end;
  send("POST", "/api/pick", pick, [&](HttpResponse) {  // on the worker's thread
    begun.set_value();
    end.get_future().wait();
  });
  begun.get_future().wait();
  for (int i = 0; i < 15; ++i) EXPECT_EQ(status_now("POST", "/api/pick", pick), 0);
  EXPECT_EQ(status_now("POST", "/api/pick", pick), 503);
  EXPECT_EQ(status_now("POST", "/api/edit", rough), 503);
  EXPECT_EQ(status_now("POST", "/api/preview", rough), 503);
  EXPECT_EQ(status_now("POST", "/api/export", {{"file", "ball.ply"}}), 503);
  EXPECT_EQ(status_now("POST", "/api/turntable", {{"file", "ball.zip"}, {"turntable", 1}}), 503);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(status_now("GET", "/api/pack/look"), 0);
  EXPECT_EQ(status_now("GET", "/api/pack/look"), 503);
  end.set_value();
  editor_->wait_until_idle();
  EXPECT_EQ(post("/api/edit", rough).status, 200);
}

}  // namespace
}  // namespace cei3d

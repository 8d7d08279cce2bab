// SPDX-License-Identifier: Apache-2.0
// What the editor shows of a folder.
#include "apps/server/library.h"

#include "apps/server/test_editor.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "engine/capture/capture.h"

namespace cei3d {
namespace {

class EditorLibrary : public ::testing::Test {
 protected:
  void start() {
    editor_.reset();
    EditorOptions options;
    options.path = temp_.path();
    options.device = "cpu";
    editor_ = std::make_unique<Editor>(options, Guard(kTestToken));
    editor_->wait_until_idle();
  }
  HttpResponse ask(const std::string& method, const std::string& path, const std::string& body = {}) {
    HttpRequest r;
    r.method = method;
    r.path = path;
    r.body = body;
    std::promise<HttpResponse> promise;
    editor_->answer(r, [&](HttpResponse response) { promise.set_value(std::move(response)); });
    return promise.get_future().get();
  }
  Json entries() {
    start();
    const Json state = Json::parse(ask("GET", "/api/state").body);
    EXPECT_EQ(state["mode"], "library");
    return state["entries"];
  }

  TempFolder temp_;
  std::unique_ptr<Editor> editor_;
};

TEST_F(EditorLibrary, ListsProjectsAndCapturesAndExplainsAnEmptyFolder) {
  EXPECT_TRUE(entries().empty());
  Project::create(temp_.path() / "ball", {}, three_views(), false).save_base(sphere_with_handlers());
  std::filesystem::create_directory(temp_.path() / "other");
  const Json all = entries();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["id"], "ball");
  EXPECT_EQ(all[0]["problem"], "");
}

TEST_F(EditorLibrary, SaysWhatIsWrongWithADamagedCapture) {
  write_file_atomic(temp_.path() / "broken/transforms.json", "{");
  const std::string sentence = message([&] { load_capture(temp_.path() / "broken"); });
  const Json all = entries();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["id"], "broken");
  EXPECT_EQ(all[0]["problem"], sentence);
  const HttpResponse refused = ask("POST", "/api/open", R"({"id": "broken"})");
  EXPECT_EQ(refused.status, 422);
  EXPECT_EQ(Json::parse(refused.body)["error"], sentence);
  EXPECT_EQ(Json::parse(ask("GET", "/api/state").body)["mode"], "library");
}

}  // namespace
}  // namespace cei3d

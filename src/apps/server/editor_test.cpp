// SPDX-License-Identifier: Apache-2.0
// Edits, their history, and questions about the object.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/server/edit_json.h"
#include "apps/server/test_editor.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "engine/io/png_file.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

Json paint_params(const Json& camera, const std::string& scribble) {
  return {{"strokes", {{{"camera", camera}, {"scribble", scribble}}}}};
}

std::vector<std::string> result_objects(const std::filesystem::path& project) {
  std::vector<std::string> objects;
  for (const auto& e : std::filesystem::recursive_directory_iterator(project / "edits"))
    if (e.path().filename() == "edit.json") {
      const Json edit = Json::parse(read_file(e.path()));
      for (const auto& [key, r] : edit["results"].items())
        objects.push_back(r["object"].get<std::string>() + r["head"].dump());
    }
  std::sort(objects.begin(), objects.end());
  return objects;
}

// The same edits as in the test below, made by the commands of the session. file: the scribble.
void edit_by_commands(Session& session, const std::filesystem::path& file) {
  Progress quiet;
  session.paint({{{"train/r_0", file}}}, quiet);
  PartCommand part;
  part.view = "train/r_0";
  part.positive = {{24, 24}};
  part.name = "cap";
  part.in_view = true;
  session.select_part(part, quiet);
  MaterialCommand material{"cap", {}};
  material.effects.roughness = 0.4;
  material.effects.metalness = 1;
  session.change_material(material, quiet);
  session.change_light({"", 40, EnvConvention::by_up_axis, 1.5}, quiet);
  session.deform({PixelDrag{"train/r_0", {24, 24}, {4, 2}, {}}, 0.35, ""}, quiet);
  session.paint({{{"train/r_0", file, {}, DecalPlace{{26, 22}, 0.3, 30}}}}, quiet);
  session.change_light({"", 0, EnvConvention::by_up_axis, 1, Sun{{1, 0, 1}, 2}}, quiet);
  DeformCommand bend{PointDrag{{0, 0, 0.7}, {0, 0, 0.8}, {0, 0, 20}}, 0.3, ""};
  bend.more = {{{0.7, 0, 0}, {0.75, 0, 0}}};
  bend.pins = {{0, 0.7, 0}};
  session.deform(bend, quiet);
}

TEST_F(EditorTest, EveryToolGivesTheObjectsOfItsCommand) {
  const std::string png = encode_png(square_scribble({0.8f, 0.1f, 0.1f}, 6), 8);
  const auto done = [&](const std::string& op, const Json& params) {
    const HttpResponse r = post("/api/edit", {{"op", op}, {"params", params}});
    EXPECT_EQ(r.status, 200) << r.body;
  };
  done("paint", paint_params(camera(0), upload(png)));
  done("part", {{"camera", camera(0)}, {"positive", {{24, 24}}}, {"name", "cap"}, {"in_view", true}});
  done("material", {{"part", "cap"}, {"roughness", 0.4}, {"metalness", 1}});
  done("light", {{"rotate", 40}, {"scale", 1.5}});
  done("deform", {{"camera", camera(0)}, {"pixel", {24, 24}}, {"drag", {4, 2}}, {"radius", 0.35}});
  const Json decal = {{"pixel", {26, 22}}, {"width", 0.3}, {"turn", 30}};
  done("paint", {{"strokes", {{{"camera", camera(0)}, {"scribble", upload(png)}, {"decal", decal}}}}});
  done("light", {{"sun", {{"direction", {1, 0, 1}}, {"strength", 2}}}});
  done("deform", {{"from", {0, 0, 0.7}},
                  {"to", {0, 0, 0.8}},
                  {"turn", {0, 0, 20}},
                  {"more", {{{"from", {0.7, 0, 0}}, {"to", {0.75, 0, 0}}}}},
                  {"pins", {{0, 0.7, 0}}},
                  {"radius", 0.3}});
  const std::vector<std::string> by_editor = result_objects(folder());
  ASSERT_EQ(by_editor.size(), 8u);

  editor_.reset();
  const std::filesystem::path other = temp_.path() / "other", file = temp_.path() / "scribble.png";
  Project::create(other, {}, three_views(), false).save_base(sphere_with_handlers());
  write_file_atomic(file, png);
  Session session("cpu");
  session.open(other, Session::Access::write);
  edit_by_commands(session, file);
  EXPECT_EQ(result_objects(other), by_editor);
}

TEST_F(EditorTest, TheHistoryIsThatOfTheProject) {
  const Json rough = {{"op", "material"}, {"params", {{"roughness", 0.3}}}};
  post("/api/edit", rough);
  Json amended = rough;
  amended["amend"] = true;
  amended["params"]["roughness"] = 0.6;
  post("/api/edit", amended);
  post("/api/edit", {{"op", "light"}, {"params", {{"rotate", 10}}}});
  EXPECT_EQ(state()["done"], 2);
  EXPECT_EQ(state()["history"][0]["params"]["roughness"], 0.6);
  post("/api/undo", Json::object());
  EXPECT_EQ(state()["done"], 1);
  post("/api/redo", Json::object());
  post("/api/goto", {{"done", 0}});
  EXPECT_EQ(state()["done"], 0);
  const std::string light = state()["history"][1]["id"];
  post("/api/rename", {{"id", light}, {"name", "evening"}});
  post("/api/edit", {{"op", "light"}, {"params", {{"scale", 2}}}});
  EXPECT_EQ(state()["history"].size(), 3u);
  post("/api/restore", {{"id", light}});
  EXPECT_EQ(state()["done"], 2);
  EXPECT_EQ(state()["history"][1]["name"], "evening");
  post("/api/toggle", {{"id", light}});
  EXPECT_EQ(state()["history"][1]["enabled"], false);
  post("/api/forget", Json::object());
  editor_.reset();
  Session session("cpu");
  session.open(folder(), Session::Access::read);
  ASSERT_EQ(session.log().size(), 2u);
  EXPECT_EQ(session.log()[1].name, "evening");
  EXPECT_FALSE(session.log()[1].enabled);
}

TEST_F(EditorTest, SaysWhichPhotographsAreThere) {
  const std::filesystem::path photo = temp_.path() / "photo.png";
  Capture capture = three_views();
  capture.views[0].image_path = photo;
  capture.views[1].image_path = temp_.path() / "gone.png";
  write_file_atomic(photo, encode_png(square_scribble({0.8f, 0.1f, 0.1f}, 6), 8));
  editor_.reset();
  std::filesystem::remove_all(folder());
  Project::create(folder(), {}, capture, false).save_base(sphere_with_handlers());
  start();
  const Json views = Json::parse(get("/api/object").body)["views"];
  EXPECT_EQ(views[0]["photo"], true);
  EXPECT_EQ(views[1]["photo"], false);
  EXPECT_EQ(views[2]["photo"], false);
}

TEST_F(EditorTest, AChangeToAnotherHistoryIsRefused) {
  const std::string before = state()["revision"];
  const Json rough = {{"op", "material"}, {"params", {{"roughness", 0.3}}}};
  EXPECT_EQ(post("/api/edit", rough, before).status, 200);
  const HttpResponse late = post("/api/edit", rough, before);
  EXPECT_EQ(late.status, 409);
  EXPECT_THAT(late.body, HasSubstr("another window"));
  EXPECT_EQ(state()["done"], 1);
  EXPECT_EQ(post("/api/undo", Json::object(), state()["revision"]).status, 200);
  EXPECT_EQ(state()["revision"] == before, false);  // the undone edit is still listed
}

TEST_F(EditorTest, APreviewIsShownAndThenKeptOrNot) {
  const Json part = {{"camera", camera(0)}, {"positive", {{24, 24}}}, {"name", "cap"}, {"in_view", true}};
  const HttpResponse made = post("/api/preview", {{"op", "part"}, {"params", part}});
  ASSERT_EQ(made.status, 200) << made.body;
  const std::string token = Json::parse(made.body)["token"];
  EXPECT_EQ(state()["history"].size(), 0u);
  const HttpResponse mask = post("/api/mask", {{"camera", camera(0)}, {"token", token}});
  ASSERT_EQ(mask.type, "image/png");
  EXPECT_EQ(decode_png(mask.body, "mask").at(24, 24)[0], 1);
  EXPECT_EQ(post("/api/commit", {{"token", token}}).status, 200);
  EXPECT_EQ(state()["parts"][0]["name"], "cap");
  EXPECT_EQ(post("/api/commit", {{"token", token}}).status, 422);  // the history has changed
  EXPECT_EQ(post("/api/commit", {{"token", "preview999"}}).status, 400);
}

TEST_F(EditorTest, AStepOfTheHistoryHasAPicture) {
  post("/api/edit", {{"op", "light"}, {"params", {{"scale", 0.25}}}});
  const Json step = {{"camera", camera(0)}, {"done", 0}};
  const HttpResponse first = post("/api/step", step, state()["revision"]);
  ASSERT_EQ(first.type, "image/png") << first.body;
  const auto middle = [&](const HttpResponse& r) { return decode_png(r.body, "step").at(24, 24)[0]; };
  EXPECT_GT(middle(first), middle(post("/api/step", {{"camera", camera(0)}, {"done", 1}})));
  EXPECT_EQ(state()["done"], 1);
  EXPECT_EQ(post("/api/step", step, "another").status, 409);
  EXPECT_EQ(post("/api/step", {{"camera", camera(0)}, {"done", 2}}).status, 400);
}

TEST_F(EditorTest, TellsWhatIsUnderThePointer) {
  const Json on = Json::parse(post("/api/pick", {{"camera", camera(0)}, {"pixel", {24, 24}}}).body);
  EXPECT_EQ(on["albedo"].get<std::string>().size(), 7u);
  EXPECT_EQ(post("/api/pick", {{"camera", camera(0)}, {"pixel", {0, 0}}}).body, "null");
}

TEST_F(EditorTest, ADecalIsSeenByItsCamera) {
  const Json decal = {{"pixel", {24, 24}}, {"width", 0.2}};
  const auto over = [&](const Json& place) {
    return post("/api/decal", {{"camera", camera(0)}, {"decal", place}, {"size", {64, 32}}});
  };
  EXPECT_EQ(Json::parse(over(decal).body)["width"], 64);
  EXPECT_EQ(over({{"pixel", {0, 0}}, {"width", 0.2}}).body, "null");
  EXPECT_EQ(over({{"pixel", {24, 24}}, {"width", -1}}).status, 400);
}

TEST_F(EditorTest, BadRequestsAreSentencesAndChangeNothing) {
  const std::string before = files_of(folder());
  const std::pair<const char*, Json> bad[] = {
      {"edit", {{"op", "explode"}, {"params", Json::object()}}},
      {"edit", {{"op", "material"}, {"params", {{"roughness", 7}}}}},
      {"edit", {{"op", "material"}, {"params", {{"rugosity", 0.5}}}}},
      {"edit", {{"op", "paint"}, {"params", {{"strokes", Json::array()}}}}},
      {"edit", {{"op", "paint"}, {"params", paint_params(camera(0), "nothing")}}},
      {"edit", {{"op", "remove"}, {"params", {{"part", "<img onerror>"}}}}},
      {"pick", {{"camera", {{"width", 1}}}, {"pixel", {1, 1}}}},
      {"goto", {{"done", 5}}},
      {"rename", {{"id", "../../x"}, {"name", "x"}}},
      {"restore", {{"id", "x"}}},
      {"export", {{"file", "ball.exe"}}},
      {"export", {{"file", "../../ball.ply"}, {"color", 1}}},
      {"nothing", Json::object()}};
  for (const auto& [route, body] : bad) {
    const HttpResponse r = post(std::string("/api/") + route, body);
    EXPECT_GE(r.status, 400) << route << body;
    EXPECT_LT(r.status, 500) << route << body;
    EXPECT_FALSE(Json::parse(r.body)["error"].get<std::string>().empty());
  }
  HttpRequest broken;
  broken.method = "POST";
  broken.path = "/api/edit";
  for (const std::string& body :
       {std::string("{\"op\":"), std::string(100'000, '[') + std::string(100'000, ']')}) {
    broken.body = body;
    EXPECT_EQ(ask(broken).status, 400);
  }
  for (const char* path :
       {"/api/none", "/api/photo/..%2f..%2fetc%2fpasswd", "/api/download/..%2fproject.json",
        "/app/../editor.h", "/app/%2e%2e/x", "/etc/passwd", "/api/photo/%zz"})
    EXPECT_GE(get(path).status, 400) << path;
  EXPECT_EQ(files_of(folder()), before);
}

TEST_F(EditorTest, ScribblesAndMasksAreLimitedInSize) {
  Uploads uploads;
  const std::string id = uploads.add("scribble.png", "a picture");
  const Json paint = paint_params(camera(0), id);
  const Json part = {{"camera", camera(0)}, {"mask", id}, {"name", "cap"}};
  std::filesystem::resize_file(uploads.path(id), 64 << 20);
  EXPECT_NO_THROW(edit_command("paint", paint, uploads));
  std::filesystem::resize_file(uploads.path(id), (64 << 20) + 1);
  for (const auto& [op, params] : {std::pair("paint", paint), std::pair("part", part)})
    EXPECT_THAT(message([&, &op = op, &params = params] { edit_command(op, params, uploads); }),
                HasSubstr("at most 64 MiB"))
        << op;
}

// After a restart a page sends its files again; a status of its own tells it when to.
TEST_F(EditorTest, FilesThatAreGoneAreAskedForAgain) {
  const Json edit = {{"op", "paint"}, {"params", paint_params(camera(0), "never sent")}};
  EXPECT_EQ(post("/api/edit", edit).status, 410);
}

TEST_F(EditorTest, ExportsGoToTheProjectAndCanBeFetched) {
  const HttpResponse r = post("/api/export", {{"file", "../ball.ply"}});
  ASSERT_EQ(r.status, 200) << r.body;
  EXPECT_EQ(Json::parse(r.body)["files"][0]["name"], "ball.ply");
  EXPECT_EQ(get("/api/download/ball.ply").body, read_file(folder() / "exports" / "ball.ply"));
}

TEST_F(EditorTest, ReadOnlyShowsAndChangesNothing) {
  start(true);
  EXPECT_EQ(state()["read_only"], true);
  EXPECT_EQ(post("/api/edit", {{"op", "material"}, {"params", {{"roughness", 0.3}}}}).status, 403);
  EXPECT_EQ(post("/api/undo", Json::object()).status, 403);
  EXPECT_EQ(post("/api/pick", {{"camera", camera(0)}, {"pixel", {24, 24}}}).status, 200);
}

TEST_F(EditorTest, AProjectThatAnotherProgramChangesIsOpenedReadOnly) {
  editor_.reset();
  Project other = Project::open(folder(), Project::Mode::write);
  start();
  EXPECT_EQ(state()["read_only"], true);
  EXPECT_THAT(state()["note"].get<std::string>(), HasSubstr("Another cei3d"));
}

TEST_F(EditorTest, HoldsTheLockWhileItIsOpen) {
  EXPECT_THROW(Project::open(folder(), Project::Mode::write), InUseError);
  editor_->say_address("http://127.0.0.1:7861");
  editor_->wait_until_idle();
  EXPECT_THAT(message([&] { Project::open(folder(), Project::Mode::write); }),
              HasSubstr("the editor at http://127.0.0.1:7861"));
  editor_.reset();
  EXPECT_NO_THROW(Project::open(folder(), Project::Mode::write));
}

}  // namespace
}  // namespace cei3d

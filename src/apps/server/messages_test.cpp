// SPDX-License-Identifier: Apache-2.0
// Makes the types of the program's messages, which the modules of the page use, from examples of these
// messages. The test fails if src/web/editor/messages.js differs from them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "apps/server/test_editor.h"
#include "core/base/file.h"
#include "core/base/test_source.h"
#include "engine/io/png_file.h"

namespace cei3d {
namespace {

constexpr const char* kFile = "src/web/editor/messages.js";

// Members that are objects whose keys depend on the kind of edit.
const std::set<std::string> kOpen = {"params", "report", "result"};

std::string type_of(const std::vector<Json>& examples);

std::string object_type(const std::vector<Json>& examples) {
  std::map<std::string, std::vector<Json>> values;
  for (const Json& e : examples)
    for (const auto& [key, value] : e.items()) values[key].push_back(value);
  std::string text;
  for (const auto& [key, list] : values) {
    text += text.empty() ? "" : ", ";
    text +=
        key + (list.size() < examples.size() ? "?: " : ": ") + (kOpen.contains(key) ? "any" : type_of(list));
  }
  return "{" + text + "}";
}

std::string array_type(const std::vector<Json>& examples) {
  std::vector<Json> elements;
  for (const Json& e : examples) elements.insert(elements.end(), e.begin(), e.end());
  const bool vectors = std::all_of(examples.begin(), examples.end(), [](const Json& e) {
    return e.size() == 3 && e[0].is_number() && e[1].is_number() && e[2].is_number();
  });
  if (vectors) return "[number, number, number]";
  return elements.empty() ? "any[]" : type_of(elements) + "[]";
}

std::string type_of(const std::vector<Json>& examples) {
  std::map<std::string, std::vector<Json>> kinds;
  for (const Json& e : examples) kinds[e.is_number() ? "number" : e.type_name()].push_back(e);
  std::string text;
  for (const auto& [kind, list] : kinds) {
    text += text.empty() ? "" : " | ";
    text += kind == "object" ? object_type(list) : kind == "array" ? array_type(list) : kind;
  }
  return text;
}

class MessagesTest : public EditorTest {
 protected:
  void add(const std::string& name, const Json& example) { examples_[name].push_back(example); }

  // One edit of every kind: their entries in the history differ.
  void edit_all() {
    const auto done = [&](const std::string& op, const Json& params) {
      const HttpResponse r = post("/api/edit", {{"op", op}, {"params", params}});
      ASSERT_EQ(r.status, 200) << r.body;
      add("Changed", Json::parse(r.body));
    };
    const Json part = {{"camera", camera(0)}, {"positive", {{24, 24}}}, {"name", "cap"}, {"in_view", true}};
    done("part", part);
    const std::string png = encode_png(square_scribble({0.8f, 0.1f, 0.1f}, 6), 8);
    done("paint", {{"strokes", {{{"camera", camera(0)}, {"scribble", upload(png)}}}}});
    done("light", {{"rotate", 40}});
    post("/api/rename", {{"id", state()["history"][0]["id"]}, {"name", "cap"}});
    const HttpResponse preview = post("/api/preview", {{"op", "material"}, {"params", {{"roughness", 0.3}}}});
    add("Preview", Json::parse(preview.body));
    post("/api/undo", Json::object());
    done("material", {{"roughness", 0.4}});  // sets the light aside
  }

  void look() {
    const auto socket = std::make_shared<FakeSocket>();
    editor_->opened(socket);
    editor_->received(socket, Json{{"type", "hello"}, {"token", kTestToken}}.dump());
    editor_->received(socket, Json{{"type", "view"}, {"seq", 7}, {"camera", camera(0)}}.dump());
    editor_->received(socket, "{\"type\": \"explode\"}");
    post("/api/export", {{"file", "ball.ply"}});
    post("/api/edit", {{"op", "material"}, {"params", {{"roughness", 0.5}}}});
    editor_->wait_until_idle();
    const std::map<std::string, std::string> names = {{"welcome", "Welcome"},
                                                      {"frame", "FrameNews"},
                                                      {"state", "StateNews"},
                                                      {"progress", "ProgressNews"},
                                                      {"error", "ErrorNews"}};
    for (const Json& j : socket->texts) add(names.at(j["type"]), j);
    for (const std::string& bytes : socket->pictures)
      add("TileHead", Json::parse(bytes.substr(
                          4, size_t((unsigned char)bytes[0]) + 256 * size_t((unsigned char)bytes[1]))));
    editor_->closed(socket);
  }

  std::string text() const {
    std::string out =
        "// SPDX-License-Identifier: Apache-2.0\n"
        "// @ts-check\n"
        "/** What the program sends, made from examples by src/apps/server/messages_test.cpp. */\n\n";
    for (const auto& [name, list] : examples_)
      out += "/** @typedef {" + type_of(list) + "} " + name + " */\n";
    return out + "export {};\n";
  }

  std::map<std::string, std::vector<Json>> examples_;
};

TEST_F(MessagesTest, TheTypesOfThePageAreThoseOfTheProgram) {
  add("ProjectState", state());
  edit_all();
  look();
  add("ProjectState", state());
  add("ObjectInfo", Json::parse(get("/api/object").body));
  add("Picked", Json::parse(post("/api/pick", {{"camera", camera(0)}, {"pixel", {24, 24}}}).body));
  add("Failure", Json::parse(post("/api/nothing", Json::object()).body));
  const std::string now = text();
  write_file_atomic(source_file("build/messages.js"), now);
  EXPECT_EQ(read_file(source_file(kFile)), now)
      << "Copy build/messages.js to " << kFile
      << " and run tools/lint.sh quick, which shows what uses other types.";
}

TEST(Messages, TypesComeFromExamples) {
  EXPECT_EQ(type_of({Json{{"a", 1}, {"b", "x"}}, Json{{"a", nullptr}}}), "{a: null | number, b?: string}");
  EXPECT_EQ(type_of({Json::parse("[[1, 2, 3], [4, 5, 6]]")}), "[number, number, number][]");
  EXPECT_EQ(type_of({Json::parse("[]"), Json::parse("[true]")}), "boolean[]");
  EXPECT_EQ(type_of({Json{{"params", {{"x", 1}}}}}), "{params: any}");
}

}  // namespace
}  // namespace cei3d

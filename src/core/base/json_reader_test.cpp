// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_of.h"
#include "core/base/name_distance.h"

namespace cei3d {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(JsonReader, ReadsWhatIsThere) {
  const Json j = Json::parse(R"({"a": 3, "b": -2.5, "c": "text", "d": true, "e": [1, 2.5, -3], "f": {"g": 7},
                                 "h": 18446744073709551615})");
  JsonReader r(j, "the test");
  EXPECT_EQ(r.require<int>("a"), 3);
  EXPECT_EQ(r.require<double>("a"), 3.0);
  EXPECT_EQ(r.require<double>("b"), -2.5);
  EXPECT_EQ(r.require<std::string>("c"), "text");
  EXPECT_TRUE(r.require<bool>("d"));
  EXPECT_EQ(r.numbers<3>("e"), (std::array<double, 3>{1, 2.5, -3}));
  JsonReader inner = r.object("f");
  EXPECT_EQ(inner.optional<int>("g"), 7);
  EXPECT_EQ(inner.optional<int>("missing"), std::nullopt);
  EXPECT_EQ(inner.optional<int>("missing", 5), 5);
  EXPECT_FALSE(inner.has("missing"));
  inner.finish();
  EXPECT_EQ(r.require<uint64_t>("h"), ~uint64_t(0));
  r.finish();
  const Json made = {{"signed", 5}};  // in memory a number may be signed that is stored without a sign
  EXPECT_EQ(JsonReader(made, "it").require<size_t>("signed"), 5u);
}

TEST(JsonReader, UnknownKeysAreNamedWithTheNearestKnownOne) {
  const Json j = {{"roughness", 0.5}, {"metalnes", 1}};
  JsonReader r(j, "the parameters of edit 0001-material");
  r.require<double>("roughness");
  r.optional<double>("metalness");
  r.optional<double>("specular");
  EXPECT_THAT(message([&] { r.finish(); }), AllOf(HasSubstr("the parameters of edit 0001-material"),
                                                  HasSubstr("'metalnes'"), HasSubstr("'metalness'")));
  EXPECT_THAT(message([&] { JsonReader(j, "it").finish(); }), HasSubstr("'roughness'"));
}

TEST(JsonReader, AThingIsNamedAsItsPlaceInTheSentenceAsks) {
  const Json j = {{"light", {{"lobs", 1}}}};
  JsonReader r(j, "The object");
  EXPECT_THAT(message([&] { r.object("light").finish(); }), HasSubstr("'light' of the object has"));
  EXPECT_THAT(message([&] { JsonReader(j, "The object").finish(); }), HasSubstr("The object has"));
}

TEST(JsonReader, MissingKeysAndWrongTypesAreNamed) {
  const Json j =
      Json::parse(R"({"i": 1.5, "n": -1, "big": 3000000000, "t": 3, "b": 1, "list": [1, "x"], "o": []})");
  JsonReader r(j, "file.json");
  EXPECT_THAT(message([&] { r.require<int>("absent"); }),
              AllOf(HasSubstr("file.json"), HasSubstr("'absent'")));
  for (const auto& run : std::vector<std::function<void()>>{
           [&] { r.require<int>("i"); }, [&] { r.require<size_t>("n"); }, [&] { r.require<int>("big"); },
           [&] { r.require<std::string>("t"); }, [&] { r.require<bool>("b"); }, [&] { r.numbers<2>("list"); },
           [&] { r.numbers<3>("list"); }, [&] { r.object("o"); }, [&] { r.array("t"); },
           [&] { r.optional<double>("list"); }, [&] { JsonReader(j.at("o"), "file.json"); }})
    EXPECT_THAT(message(run), AllOf(HasSubstr("file.json"), HasSubstr("belongs")));
  EXPECT_EQ(r.require<int>("n"), -1);
  EXPECT_EQ(r.require<int64_t>("big"), 3000000000);
}

TEST(NameDistance, CountsLetters) {
  EXPECT_EQ(name_distance("", "abc"), 3u);
  EXPECT_EQ(name_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(name_distance("same", "same"), 0u);
  const std::string known[] = {"specular", "roughness", "replace"};
  EXPECT_EQ(nearest_name("roughnes", known), "roughness");
  EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
}  // namespace cei3d

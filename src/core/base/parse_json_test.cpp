// SPDX-License-Identifier: Apache-2.0
#include "core/base/parse_json.h"

#include <gtest/gtest.h>

#include <string>

namespace cei3d {
namespace {

std::string nested(int depth) { return std::string(size_t(depth), '[') + std::string(size_t(depth), ']'); }

TEST(ParseJson, DepthIsLimited) {
  EXPECT_TRUE(parse_json(nested(kMaxJsonDepth)).is_array());
  EXPECT_TRUE(parse_json(nested(kMaxJsonDepth + 1)).is_discarded());
  EXPECT_TRUE(parse_json(nested(1'000'000)).is_discarded());
  std::string objects = "1";
  for (int i = 0; i < 200; ++i) objects = "{\"a\":" + objects + "}";
  EXPECT_TRUE(parse_json(objects).is_discarded());
}

TEST(ParseJson, BracketsInStringsAreText) {
  const std::string open(1000, '[');
  const auto first = [](const std::string& text) { return parse_json(text)[0].get<std::string>(); };
  EXPECT_EQ(first("[\"" + open + "\"]"), open);
  EXPECT_EQ(first("[\"\\\"" + open + "\"]"), "\"" + open);
  EXPECT_EQ(first("[\"\\\\\"," + nested(3) + "]"), "\\");
  EXPECT_TRUE(parse_json("[\"\\\\\"," + nested(100) + "]").is_discarded());
}

TEST(ParseJson, WhatIsNoJsonIsDiscarded) {
  for (const char* text : {"", "{", "nan", "[1,]", "\"", "\"\\"})
    EXPECT_TRUE(parse_json(text).is_discarded()) << text;
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "core/base/json.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

struct Streams {
  std::ostringstream out, err;
};

TEST(Console, AnAnswerIsTextOrJsonAndEndsItsLine) {
  Streams text, json;
  Console(text.out, text.err, false).answer({{"edits", 2}}, "two edits");
  EXPECT_EQ(text.out.str(), "two edits\n");
  Console console(json.out, json.err, false);
  console.set_json(true);
  console.answer({{"edits", 2}}, "two edits");
  EXPECT_EQ(Json::parse(json.out.str()), Json({{"edits", 2}}));
  EXPECT_EQ(text.err.str() + json.err.str(), "");
}

TEST(Console, AQuietOneAnswersOnlyQuestions) {
  Streams s;
  Console console(s.out, s.err, false);
  console.set_level(LogLevel::error);
  console.done({}, "painted");
  console.warn("dark pictures");
  console.log("{}");
  EXPECT_EQ(s.out.str() + s.err.str(), "");
  console.answer({}, "on");
  EXPECT_EQ(s.out.str(), "on\n");
}

TEST(Console, WithJsonEvenAQuietOneSaysWhatWasDone) {
  Streams s;
  Console console(s.out, s.err, false);
  console.set_level(LogLevel::error);
  console.set_json(true);
  console.done({{"id", "0001-paint"}}, "painted");
  EXPECT_EQ(Json::parse(s.out.str())["id"], "0001-paint");
}

TEST(Console, AnErrorIsTwoSentencesOnStandardError) {
  Streams s;
  Console(s.out, s.err, false).error("x.png is damaged", "export it again", 1);
  EXPECT_EQ(s.err.str(), "error: x.png is damaged. Export it again.\n");
  EXPECT_EQ(s.out.str(), "");
}

TEST(Console, WithJsonAnErrorIsAnObjectToo) {
  Streams s;
  Console console(s.out, s.err, false);
  console.set_json(true);
  console.error("Is it there?", "", 2);
  EXPECT_EQ(Json::parse(s.out.str()), Json({{"error", "Is it there?"}, {"exit_code", 2}}));
  EXPECT_EQ(s.err.str(), "error: Is it there?\n");
}

TEST(Console, StandardOutputHoldsOneObjectEvenWhereAnErrorFollowsAnAnswer) {
  Streams s;
  Console console(s.out, s.err, false);
  console.set_json(true);
  console.answer({{"id", 1}}, "");
  console.error("interrupted", "", 130);
  EXPECT_EQ(Json::parse(s.out.str()), Json({{"id", 1}}));
}

TEST(Console, ATerminalGetsABarThatTheNextLineReplaces) {
  Streams s;
  Console console(s.out, s.err, true);
  console.report({"geometry", 0.5, 90, "loss 0.1"});
  EXPECT_THAT(s.err.str(), HasSubstr("[############............]  50%  1:30 left  loss 0.1"));
  const size_t drawn = s.err.str().size();
  console.warn("dark pictures");
  EXPECT_EQ(s.err.str().substr(drawn), "\r\x1b[Kwarning: dark pictures\n");
}

TEST(Console, StepsAreForThoseWhoDebug) {
  Streams s;
  Console console(s.out, s.err, false);
  console.log("{\"step\": 1}");
  EXPECT_EQ(s.err.str(), "");
  console.set_level(LogLevel::debug);
  console.log("{\"step\": 2}");
  EXPECT_EQ(s.err.str(), "{\"step\": 2}\n");
}

}  // namespace
}  // namespace cei3d

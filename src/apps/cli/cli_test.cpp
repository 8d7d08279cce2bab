// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/cli.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "apps/cli/parse.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Typed {
  int code;
  std::string out, err;
};

Typed type(const std::vector<std::string>& args) {
  std::ostringstream out, err;
  const int code = run_cli(args, out, err, false);
  return {code, out.str(), err.str()};
}

const std::vector<std::string> kVerbs = {"check",  "reconstruct", "render", "edit",       "log",   "undo",
                                         "redo",   "toggle",      "replay", "export",     "eval",  "info",
                                         "doctor", "synth",       "demo",   "completion", "manual"};

TEST(Cli, HelpNamesEveryVerb) {
  const Typed t = type({"--help"});
  EXPECT_EQ(t.code, 0);
  EXPECT_EQ(t.err, "");
  for (const std::string& verb : kVerbs) EXPECT_THAT(t.out, HasSubstr("\n  " + verb + " ")) << verb;
  EXPECT_THAT(t.out, HasSubstr("Exit codes"));
}

TEST(Cli, EveryVerbHasHelp) {
  for (const std::string& verb : kVerbs) {
    const Typed t = type({verb, "-h"});
    EXPECT_EQ(t.code, 0) << verb;
    EXPECT_THAT(t.out, HasSubstr("Usage")) << verb;
  }
  const Typed paint = type({"edit", "paint", "-h"});
  EXPECT_EQ(paint.code, 0);
  EXPECT_THAT(paint.out, HasSubstr("--scribble"));
}

TEST(Cli, HelpShowsDefaults) {  // as the installed CLI11 writes them
  EXPECT_THAT(type({"reconstruct", "-h"}).out, AnyOf(HasSubstr("[fast]"), HasSubstr("=fast")));
  EXPECT_THAT(type({"render", "-h"}).out, AnyOf(HasSubstr("[rgb]"), HasSubstr("=rgb")));
}

TEST(Cli, HelpOfAnUnknownCommandIsAnError) {
  const Typed t = type({"frobnicate", "-h"});
  EXPECT_EQ(t.code, 2);
  EXPECT_EQ(t.out, "");
}

TEST(Cli, HelpOfAnEditNamesTheProject) {
  EXPECT_THAT(type({"edit", "paint", "-h"}).out, HasSubstr("edit PROJECT paint"));
}

TEST(Cli, HelpNamesEveryCaptureFormat) {
  const std::string help = type({"-h"}).out;
  EXPECT_THAT(help, HasSubstr(capture_format_layouts("\n  ")));
  EXPECT_THAT(type({"check", "-h"}).out, HasSubstr(capture_format_names()));
}

TEST(Cli, SettingsOfEditsAreListed) {
  const std::pair<const char*, const char*> lines[] = {{"paint", "branch.steps = 400 steps"},
                                                       {"part", "graph.crease = 0.03 "},
                                                       {"deform", "refit.steps = 500 steps"}};
  for (const auto& [edit, line] : lines) {
    const Typed t = type({"edit", edit, "--list-settings"});
    EXPECT_EQ(t.code, 0) << t.err;
    EXPECT_THAT(t.out, HasSubstr(line));
  }
  EXPECT_THAT(type({"edit", "part", "--list-settings", "--json"}).out, HasSubstr("\"like.roughness\""));
}

TEST(Cli, MaterialsAreListedAndNearNamesAreTold) {
  for (const char* edit : {"material", "part", "paint"}) {
    const std::string help = type({"edit", edit, "-h"}).out;
    for (const char* name : {"gold", "silver", "rubber", "wood"}) EXPECT_THAT(help, HasSubstr(name)) << edit;
  }
  const Typed near = type({"edit", "p", "material", "--material", "gould"});
  EXPECT_EQ(near.code, 2);
  EXPECT_THAT(near.err, HasSubstr("gold"));
  EXPECT_THAT(near.err, Not(HasSubstr("rubber")));
  EXPECT_THAT(type({"edit", "p", "material", "--material", "unobtainium"}).err, HasSubstr("rubber"));
}

TEST(Cli, Version) {
  const Typed t = type({"--version"});
  EXPECT_EQ(t.code, 0);
  EXPECT_THAT(t.out, HasSubstr("cei3d 0."));
}

const std::vector<std::vector<std::string>> kWrongLines = {
    {},
    {"frobnicate"},
    {"check"},
    {"reconstruct", "photos"},
    {"reconstruct", "-o", "x"},
    {"reconstruct", "photos", "-o", "x", "--preset", "gigantic"},
    {"reconstruct", "photos", "-o", "x", "--time", "soon"},
    {"reconstruct", "photos", "-o", "x", "--time", "1m", "--iterations", "5"},
    {"reconstruct", "photos", "-o", "x", "--resume", "--force"},
    {"reconstruct", "photos", "-o", "x", "--downscale", "65"},
    {"reconstruct", "photos", "-o", "x", "--joint", "-2"},
    {"reconstruct", "photos", "-o", "x", "--bogus"},
    {"render", "p"},
    {"render", "p", "-o", "d", "--channels", "rgb,smell"},
    {"render", "p", "-o", "d", "--size", "800"},
    {"render", "p", "-o", "d", "--cameras", "c", "--turntable", "3"},
    {"render", "p", "-o", "d", "--samples", "0"},
    {"render", "p", "-o", "d", "--env", "no/such.hdr"},
    {"edit", "p"},
    {"edit", "paint", "--view", "r_0", "--scribble", "s.png"},
    {"edit", "p", "paint", "--view", "r_0"},
    {"edit", "p", "paint", "--view", "r_0", "--scribble", "s.png", "--target", "smell"},
    {"edit", "p", "paint", "--view", "a", "--scribble", "s.png", "--scribble", "t.png"},
    {"edit", "p", "paint", "--view", "a", "--scribble", "s.png", "--erase", "--target", "albedo"},
    {"edit", "p", "material", "--roughness", "shiny"},
    {"edit", "p", "material", "--replace"},
    {"edit", "p", "material", "--material", "gould"},
    {"edit", "p", "material", "--roughness", "0.5", "--roughness-scale", "2"},
    {"edit", "p", "part", "--view", "a", "--positive", "1,1", "--material", "unobtainium"},
    {"edit", "p", "paint", "--view", "a", "--scribble", "s.png", "--material", ""},
    {"edit", "p", "part", "--view", "a", "--like", "1,1", "--positive", "2,2"},
    {"edit", "p", "part", "--view", "a", "--like", "1"},
    {"edit", "p", "part", "--view", "a", "--positive", "2,2", "--like-color"},
    {"edit", "p", "deform", "--from", "0,0,0", "--from", "1,0,0", "--to", "0,0,1"},
    {"edit", "p", "deform", "--from", "0,0,0", "--to", "0,0,1", "--turn", "0,0,9", "--turn", "9,0,0"},
    {"edit", "p", "deform", "--from", "0,0,0", "--to", "0,0,1", "--pin", "0,0"},
    {"edit", "p", "deform", "--from", "0,0,0", "--to", "0,0,1", "--geometry", "clay"},
    {"edit", "p", "deform", "--from", "0,0,0", "--to", "0,0,1", "--distance", "l1"},
    {"edit", "material", "--roughness", "0.5"},
    {"edit", "p", "light", "--env", "no/such.hdr"},
    {"edit", "p", "light", "--rotate", "left"},
    {"replay", "p"},
    {"toggle", "p"},
    {"log"},
    {"eval", "p", "--edit", "0001-paint", "--truth", "."},
    {"eval", "p", "--truth", ".", "--mask", "."},
    {"eval", "p", "--lpips-model", "no/such.onnx"},
    {"edit", "p", "paint", "--view", "a", "--scribble", "s.png", "--routing", "magic"},
    {"evaluate", "c"},
    {"evaluate", "c", "-o", "d", "--only", "shapes"},
    {"evaluate", "c", "-o", "d", "--views", "12,many"},
    {"evaluate", "c", "-o", "d", "--downscales", "0"},
    {"evaluate", "c", "-o", "d", "--view", "r_0"},
    {"evaluate", "c", "-o", "d", "--part-view", "r_0"},
    {"completion", "csh"},
    {"demo", "--sample", "no/such/folder"},
    {"doctor", "--log-level", "loud"},
    {"doctor", "--device", "abacus"},
};

TEST(Cli, WrongUsageIsTwo) {
  for (const auto& line : kWrongLines) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2) << ::testing::PrintToString(line) << t.err;
    EXPECT_NE(t.err, "") << ::testing::PrintToString(line);
    EXPECT_EQ(t.out, "") << ::testing::PrintToString(line);
  }
}

TEST(Cli, WrongUsageNamesTheHelpToCall) {
  EXPECT_THAT(type({"reconstruct", "photos", "--split"}).err, HasSubstr("See `cei3d reconstruct -h`"));
  EXPECT_THAT(type({"reconstruct", "photos"}).err, HasSubstr("See `cei3d reconstruct -h`"));  // no project
}

TEST(Cli, FailuresAreOneAndOneSentence) {
  const TempFolder temp;
  const std::string nowhere = (temp.path() / "nowhere").string();
  for (const std::string verb : {"log", "undo", "redo", "info", "check"}) {
    const Typed t = type({verb, nowhere});
    EXPECT_EQ(t.code, 1) << verb;
    EXPECT_THAT(t.err, HasSubstr("error: ")) << verb;
    EXPECT_THAT(t.err, HasSubstr(nowhere)) << verb;
  }
  EXPECT_EQ(type({"render", nowhere, "-o", (temp.path() / "d").string()}).code, 1);
  EXPECT_EQ(type({"reconstruct", nowhere, "-o", (temp.path() / "p").string()}).code, 1);
  EXPECT_TRUE(fs::is_empty(temp.path()));  // nothing written
}

TEST(Cli, ErrorsAreJsonWhenAsked) {
  for (const auto& line : {std::vector<std::string>{"log", "/no/such/project", "--json"},
                           {"--json", "log", "/no/such/project"}}) {
    const Typed t = type(line);
    EXPECT_EQ(t.code, 1);
    EXPECT_EQ(Json::parse(t.out)["exit_code"], 1);
  }
  EXPECT_EQ(Json::parse(type({"toggle", "p", "--json"}).out)["exit_code"], 2);
}

TEST(Cli, DoctorAnswersInBothLanguages) {
  EXPECT_THAT(type({"doctor"}).out, HasSubstr("cores"));
  const Typed t = type({"doctor", "--json"});
  EXPECT_EQ(t.code, 0);
  EXPECT_GE(Json::parse(t.out)["cores"].get<int>(), 1);
  EXPECT_EQ(t.err, "");
}

TEST(Cli, ReconstructRefusesAFolderThatHoldsSomethingElse) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "p/thesis.tex", "irreplaceable");
  for (const auto& more : {std::vector<std::string>{}, {"--force"}}) {
    std::vector<std::string> line = {"reconstruct", "photos", "-o", (temp.path() / "p").string()};
    line.insert(line.end(), more.begin(), more.end());
    const Typed t = type(line);
    EXPECT_EQ(t.code, 2);
    EXPECT_THAT(t.err, HasSubstr("is not a project"));
  }
  EXPECT_EQ(read_file(temp.path() / "p/thesis.tex"), "irreplaceable");
}

TEST(Cli, SynthDrawsACaptureThatCheckFindsUsable) {
  const TempFolder temp;
  const std::string out = (temp.path() / "ball").string(), other = (temp.path() / "other").string();
  const Typed made = type({"synth",      "-o",
                           out,          "--json",
                           "--quiet",    "--shape",
                           "ball",       "--size",
                           "64x48",      "--views",
                           "20",         "--test-views",
                           "2",          "--samples",
                           "2",          "--light-tint",
                           "1,0.7,0.45", "--light-turns",
                           "--material", "clay",
                           "--material", "lid=0.3,0.5,0,#c04020,#ffffff"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out).at("views"), 20);
  const Typed checked = type({"check", out, "--json"});
  EXPECT_EQ(checked.code, 0) << checked.out;
  EXPECT_EQ(type({"synth", "-o", out}).code, 2);  // holds something
  for (const char* bad :
       {"lid=0.3", "lid=1,2,#c04020", "lid=0.3,0.5,0,red", "snout=0.3,0.5,0,#c04020", "silk"})
    EXPECT_EQ(type({"synth", "-o", other, "--material", bad}).code, 2) << bad;
  EXPECT_FALSE(fs::exists(other));
}

TEST(Parse, Durations) {
  EXPECT_EQ(parse_duration("90"), 90);
  EXPECT_EQ(parse_duration("90s"), 90);
  EXPECT_EQ(parse_duration("10m"), 600);
  EXPECT_EQ(parse_duration("1h30m"), 5400);
  EXPECT_EQ(parse_duration("0.5m"), 30);
  for (const char* bad : {"", "m", "10x", "-5", "1m-2", "nan", "inf", "0", "1e99", " 5", "0x10"})
    EXPECT_THROW(parse_duration(bad), Error) << bad;
}

TEST(Parse, Lengths) {
  EXPECT_EQ(parse_length("0.3", "--size"), 0.3);
  EXPECT_EQ(parse_length("2m", "--size"), 2);
  EXPECT_NEAR(parse_length("30cm", "--size"), 0.3, 1e-12);
  EXPECT_NEAR(parse_length("12in", "--size"), 0.3048, 1e-12);
  for (const char* bad : {"", "m", "3 m", "3km", "-1m", "0", "nan", "1e99m"})
    EXPECT_THROW(parse_length(bad, "--size"), Error) << bad;
}

TEST(Parse, DurationTexts) {
  EXPECT_EQ(duration_text(7), "0:07");
  EXPECT_EQ(duration_text(59.7), "1:00");
  EXPECT_EQ(duration_text(750), "12:30");
  EXPECT_EQ(duration_text(3723), "1:02:03");
}

TEST(Parse, Sizes) {
  EXPECT_EQ(parse_size("800x600").width, 800);
  EXPECT_EQ(parse_size("800x600").height, 600);
  for (const char* bad : {"800", "x", "800x", "800x600x3", "0x5", "-3x5", "99999x5", "800 x 600"})
    EXPECT_THROW(parse_size(bad), Error) << bad;
}

TEST(Parse, Numbers) {
  EXPECT_EQ(parse_numbers("1.5,-2,0", 3, "--from"), (std::vector<double>{1.5, -2, 0}));
  for (const char* bad :
       {"", "1,2", "1,2,3,4", "1,2,", ",1,2", "1,,2", "1,2,x", "1,2,3 ", "nan,1,2", "inf,1,2"})
    EXPECT_THROW(parse_numbers(bad, 3, "--from"), Error) << bad;
  EXPECT_THAT(message([] { parse_numbers("left", 2, "--pixel"); }), HasSubstr("--pixel"));
}

TEST(Parse, Pixels) {
  const auto pixels = parse_pixels({"120.5,88", "0,-1"}, "--pixel");
  ASSERT_EQ(pixels.size(), 2u);
  EXPECT_EQ(pixels[0].x, 120.5);
  EXPECT_EQ(pixels[0].y, 88);
  EXPECT_EQ(pixels[1].y, -1);
  EXPECT_TRUE(parse_pixels({}, "--pixel").empty());
}

TEST(Parse, Channels) {
  std::string all;
  for (const Channel c : parse_channels("rgb,albedo,diffuse,specular,normal,depth,roughness,mask"))
    all += std::string(all.empty() ? "" : ",") + channel_name(c);
  EXPECT_EQ(all, "rgb,albedo,diffuse,specular,normal,depth,roughness,mask");
  for (const char* bad : {"", "RGB", "rgb,,mask", "rgb, mask"})
    EXPECT_THROW(parse_channels(bad), Error) << bad;
}

TEST(Parse, EnvConventions) {
  EXPECT_EQ(parse_env_convention("zup"), EnvConvention::zup);
  EXPECT_EQ(parse_env_convention("mitsuba"), EnvConvention::mitsuba);
  EXPECT_THROW(parse_env_convention("sideways"), Error);
}

TEST(Parse, CamerasAreAFileOfOursOrViewsOfACapture) {
  const TempFolder temp;
  const std::string ours = (temp.path() / "render.json").string();
  const std::string theirs = (temp.path() / "transforms.json").string();
  write_file_atomic(ours, R"({"cameras": []})");
  write_file_atomic(theirs, R"({"frames": []})");
  EXPECT_EQ(std::get<CameraFile>(parse_cameras(ours)).path, ours);
  EXPECT_EQ(std::get<CaptureViews>(parse_cameras(theirs)).path, theirs);
  const CaptureViews views = std::get<CaptureViews>(parse_cameras(temp.path().string() + ":test"));
  EXPECT_EQ(views.path, temp.path());
  EXPECT_EQ(views.split, Split::test);
  EXPECT_EQ(std::get<CaptureViews>(parse_cameras(temp.path().string())).split, std::nullopt);
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// demo: makes an object from photographs, paints it, relights it and exports it, by the commands that a user
// would type.
#include <algorithm>
#include <filesystem>

#include "apps/cli/command.h"
#include "apps/cli/demo_page.h"
#include "apps/cli/demo_sample.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/system.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using Line = std::vector<std::string>;

struct Options {
  std::string out = "cei3d-demo", sample, time = "65s";
};

struct Step {
  std::string title;
  Line line;
};

// The files that the finished object is exported to.
const std::vector<DemoFile> kFiles = {
    {"spot.html", "the object, live, in one file for any browser"},
    {"spot.glb", "textured, in one file: Blender, game engines, the web"},
    {"spot.gltf", "the same with its pictures as files"},
    {"spot.obj", "the same for programs that do not read glTF"},
    {"spot.usdz", "for Apple's AR Quick Look"},
    {"spot.ply", "the finest mesh, its colors at the vertices"},
    {"spot.env.hdr", "the light, latitude-longitude"},
    {"spot.env.exr", "the same"},
    {"spot.env.json", "the light as lobes"},
};

Line export_line(const std::string& object, const std::string& out) {
  Line line{"export", object};
  for (const DemoFile& f : kFiles) line.insert(line.end(), {"-o", out + "/" + f.name});
  return line;
}

std::vector<Step> steps_of(const std::string& sample, const std::string& out, const std::string& time) {
  const std::string object = out + "/object", held_out = sample + ":test", sky = sample + "/envs/venice.hdr";
  return {
      {"Understanding the photographs", {"check", sample}},
      {"Reconstructing (" + time + " of training)",
       {"reconstruct", sample, "-o", object, "--time", time, "--force"}},
      {"Held-out views",
       {"render", object, "-o", out + "/before", "--cameras", held_out, "--channels", "rgb,albedo,normal"}},
      {"How close they are", {"eval", object, held_out}},
      {"Painting on one view",
       {"edit", object, "paint", "--view", "train/r_055", "--scribble",
        sample + "/edits/paint/scribble.png"}},
      {"The painted object in other views",
       {"render", object, "-o", out + "/painted", "--cameras", held_out, "--channels", "rgb,albedo"}},
      {"Another light", {"render", object, "-o", out + "/relit", "--cameras", held_out, "--env", sky}},
      {"The same light, turned",
       {"render", object, "-o", out + "/turned", "--cameras", held_out, "--env", sky, "--env-rotate", "90"}},
      {"All around", {"render", object, "-o", out + "/turntable", "--turntable", "12", "--size", "384x384"}},
      {"Files for other programs", export_line(object, out)},
  };
}

void run_steps(const std::vector<Step>& steps, const Commands& commands, Console& console) {
  for (const Step& step : steps) {
    std::string typed = "cei3d";
    for (const std::string& word : step.line) typed += " " + word;
    console.say(fmt::format("\n== {}\n   {}", step.title, typed));
    if (const int code = commands.run_line(step.line); code != 0)
      throw Error(ErrorCode(code), "The demo ended at: " + typed);
  }
}

// kFiles and the files that belong to them, such as textures, with their sizes.
std::vector<DemoFile> files_in(const fs::path& out) {
  std::vector<DemoFile> files = kFiles, beside;
  for (const auto& entry : fs::directory_iterator(out)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("spot") || !entry.is_regular_file()) continue;
    const auto known =
        std::find_if(files.begin(), files.end(), [&](const DemoFile& f) { return f.name == name; });
    if (known != files.end())
      known->bytes = entry.file_size();
    else
      beside.push_back({name, "part of the .gltf or the .obj", entry.file_size()});
  }
  std::sort(beside.begin(), beside.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  files.insert(files.end(), beside.begin(), beside.end());
  return files;
}

void write_page(const fs::path& sample, const fs::path& out) {
  const std::vector<std::string> views = {"r_004", "r_034"};
  for (const std::string& view : views)
    write_file_atomic(out / ("photo_" + view + ".png"), read_file(sample / "test" / (view + ".png")));
  std::vector<std::string> turntable;
  for (const auto& file : fs::directory_iterator(out / "turntable/rgb"))
    turntable.push_back(file.path().stem().string());
  std::sort(turntable.begin(), turntable.end());
  write_file_atomic(out / "index.html", demo_page(views, turntable, files_in(out)));
}

std::string report_text(const std::string& out) {
  return fmt::format(
      "\nDone. Look at\n"
      "  {0}/index.html   all pictures on one page\n"
      "  {0}/painted/rgb  the painted object (take it back: cei3d undo {0}/object)\n"
      "  {0}/turntable/rgb\n"
      "  {0}/spot.html    the object, live, in one file\n"
      "  {0}/spot.glb     the textured model, for Blender and the like; its light: {0}/spot.env.hdr\n"
      "  {0}/spot.*       the same in other formats\n"
      "  {0}/object       the project: cei3d open {0}/object\n",
      out);
}

void demo(const Options& o, const Commands& commands, Console& console) {
  const fs::path sample = o.sample.empty() ? demo_sample(program_file()) : fs::path(o.sample);
  run_steps(steps_of(sample.string(), o.out, o.time), commands, console);
  write_page(sample, o.out);
  console.done(
      {{"page", o.out + "/index.html"}, {"model", o.out + "/spot.glb"}, {"project", o.out + "/object"}},
      report_text(o.out));
}

}  // namespace

void add_demo(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add(
      "demo", "Reconstruct the sample capture, paint it, relight it, export it; says where the pictures are");
  verb->add_option("-o,--output", o->out,
                   "Folder for project, pictures and model; those of an earlier demo are replaced")
      ->capture_default_str();
  verb->add_option("--time", o->time, "Time for the reconstruction, as of `reconstruct`")
      ->capture_default_str();
  verb->add_option("--sample", o->sample,
                   "The folder samples/spot (default: the one that came with the program)")
      ->check(CLI::ExistingDirectory);
  commands.on(verb, o, [&commands](const Options& options, Session&, Console& console) {
    demo(options, commands, console);
  });
}

}  // namespace cei3d

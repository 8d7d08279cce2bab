// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

struct Options {
  std::string project, masks, out, part;
  int samples = 2;
};

void list(Session& session, Console& console) {
  Json json = Json::array();
  std::string text;
  for (const PartInfo& p : session.parts()) {
    json.push_back(p.json());
    text += fmt::format("{}{:<16} {:5.1f} % of the surface, made by {}", text.empty() ? "" : "\n", p.name,
                        100 * p.share, p.edit);
  }
  console.done({{"parts", json}}, text.empty() ? "No parts. `cei3d edit PROJECT part` makes one." : text);
}

void masks(const Options& o, Session& session, Console& console) {
  PartMasksRequest request;
  request.out = o.out;
  request.cameras = parse_cameras(o.masks);
  request.part = o.part;
  request.samples = o.samples;
  const PartMasksReport r = session.part_masks(request, console);
  console.done(r.json(), fmt::format("{}: masks of part {} in {} views; {} of them show it; {:.1f} s.", o.out,
                                     o.part, r.views, r.shown, r.seconds));
}

}  // namespace

void add_parts(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("parts", "List the named parts, or write the masks of one");
  verb->add_option("project", o->project, "Project folder")->required();
  CLI::Option* masks_option = verb->add_option(
      "--masks", o->masks,
      "Views to write masks for: CAPTURE, CAPTURE:train, :val or :test, or a FILE.json with cameras");
  CLI::Option* out = verb->add_option(
      "-o,--output", o->out, "Folder for the masks: DIR/VIEW.png, gray, coverage of each pixel by the part");
  CLI::Option* part = verb->add_option("--part", o->part, "Name of the part");
  add_samples(verb, o->samples);
  masks_option->needs(out)->needs(part);
  out->needs(masks_option);
  commands.on(verb, o, [](const Options& options, Session& session, Console& console) {
    session.open(options.project, Session::Access::read);
    options.masks.empty() ? list(session, console) : masks(options, session, console);
  });
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// info, doctor.
#include <filesystem>

#include "apps/cli/command.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string what;
};

std::string project_text(const ProjectInfo& i) {
  std::string text =
      fmt::format("project     {}\ncapture     {} ({}; {} train, {} val, {} test views)\n", i.folder.string(),
                  i.capture_root.string(), i.capture_format, i.views[0], i.views[1], i.views[2]);
  const Vec3d c = i.normalization.center;
  text += fmt::format("frame       unit sphere = (p - ({:.4g}, {:.4g}, {:.4g})) * {:.4g}\n", c.x, c.y, c.z,
                      i.normalization.scale);
  text += fmt::format("options     {}\n", i.options.dump());
  if (i.finished) {
    text += fmt::format("surface     {} vertices, {} triangles\n", i.vertices, i.triangles);
    text += fmt::format("handlers    {} points, {:.4g} apart (capture units)\n", i.handler_points,
                        i.handler_spacing);
    text += fmt::format("material    {}\n", i.object.material_text());
    if (i.object.explained)
      text += fmt::format("explained   {:.1f} dB by light and material, {:.1f} dB with the correction\n",
                          i.object.explained->physical, i.object.explained->with_residual);
    if (const std::string w = i.object.warning(); !w.empty()) text += "            " + w + "\n";
    text += fmt::format("light       {} lobes; {}\n", i.lobes, i.object.light_text());
    text += fmt::format("edits       {}, {} of them on\n", i.edits, i.edits_active);
  } else {
    text += "object      not finished; continue with `cei3d reconstruct -o PROJECT --resume`\n";
  }
  return text + fmt::format("disk        {:.1f} MB\n", double(i.bytes) / 1e6);
}

void info(const Options& o, Session& session, Console& console) {
  if (std::filesystem::exists(std::filesystem::path(o.what) / "project.json")) {
    session.open(o.what, Session::Access::read);
    const ProjectInfo i = session.info();
    console.answer(i.json(), project_text(i));
    return;
  }
  const Capture c = load_capture(parse_capture_spec(o.what).path);
  size_t count[3] = {0, 0, 0};
  for (const View& v : c.views) ++count[size_t(v.split)];
  console.answer({{"root", c.root.string()},
                  {"format", c.format},
                  {"views", {{"train", count[0]}, {"val", count[1]}, {"test", count[2]}}}},
                 fmt::format("capture     {} ({}; {} train, {} val, {} test views)\n", c.root.string(),
                             c.format, count[0], count[1], count[2]));
}

void doctor(const Options&, Session&, Console& console) {
  const MachineInfo m = Session::machine();
  std::string devices;
  for (const std::string& d : m.devices) devices += (devices.empty() ? "" : ", ") + d;
  console.answer(m.json(),
                 fmt::format("cei3d       {}\nprocessor   {}\ncores       {}\nmemory      {:.1f} "
                             "GiB\ndevices     {} (auto: {})\n",
                             m.program, m.processor, m.cores, m.memory_gib, devices, m.devices.back()));
}

}  // namespace

void add_info(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("info", "Describe a project or a capture");
  verb->add_option("what", o->what, "Project folder or capture")->required();
  commands.on(verb, o, info);
  commands.on(commands.add("doctor", "Describe this machine: processor, memory, devices"),
              std::make_shared<Options>(), doctor);
}

}  // namespace cei3d

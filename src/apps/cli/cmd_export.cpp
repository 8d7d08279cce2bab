// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/command.h"
#include "core/base/error.h"

namespace cei3d {
namespace {

struct Options {
  std::string project;
  ExportRequest request;
};

std::string report_text(const ExportReport& r) {
  const std::string file = r.out.string();
  if (r.lobes > 0) return fmt::format("{}: {} light lobes.", file, r.lobes);
  if (r.triangles == 0) return fmt::format("{}: {} points.", file, r.vertices);
  return fmt::format("{}: {} vertices, {} triangles.", file, r.vertices, r.triangles);
}

void export_object(const Options& o, Session& session, Console& console) {
  session.open(o.project, Session::Access::read);
  const ExportReport r = session.export_to(o.request, console);
  console.done(r.json(), report_text(r));
}

}  // namespace

void add_export(Commands& commands) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = commands.add("export", "Write the edited object as a file for other programs");
  verb->add_option("project", o->project, "Project folder")->required();
  verb->add_option("-o,--output", o->request.out,
                   ".glb or .ply: mesh with albedo per vertex, in the capture's frame and scale. .npy: light "
                   "lobes [M,7] (axis, sharpness, RGB peak radiance)")
      ->required();
  verb->add_flag("--points", o->request.points,
                 "With .ply: write the handler points with their normals instead of the mesh");
  commands.on(verb, o, export_object);
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/compute/device.h"
#include "engine/export/gltf.h"
#include "engine/export/object_mesh.h"
#include "engine/io/npy.h"
#include "engine/io/ply.h"
#include "engine/project/project.h"
#include "engine/session/session.h"

namespace cei3d {
namespace fs = std::filesystem;

ExportReport Session::export_to(const ExportRequest& request, Progress& progress) {
  return threads_->run([&]() -> ExportReport {
    const std::string kind = request.out.extension().string();
    if (kind != ".ply" && kind != ".glb" && kind != ".npy")
      fail_usage("{}: the ending says what to write, and it is .glb, .ply or .npy.", request.out.string());
    if (request.points && kind != ".ply") fail_usage("--points are written as .ply, not {}.", kind);
    const Scene scene = project().scene();
    progress.report({"export", 0.2, -1, ""});
    ExportReport report;
    report.out = request.out;
    if (kind == ".npy") {
      report.lobes = scene.light.lobes.size();
      write_npy(request.out, to_array(scene.light), int64_t(report.lobes), 7);
      return report;
    }
    const auto [mesh, materials] =
        request.points ? ColoredMesh{handler_point_cloud(scene), {}} : colored_mesh(*device_, scene);
    if (kind == ".ply")
      write_ply(request.out, mesh);
    else
      write_glb(request.out, mesh, materials, scene.up);
    progress.report({"export", 1, 0, ""});
    report.vertices = mesh.positions.size();
    report.triangles = mesh.triangles.size();
    return report;
  });
}

}  // namespace cei3d

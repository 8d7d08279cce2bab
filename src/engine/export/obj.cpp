// SPDX-License-Identifier: Apache-2.0
#include "engine/export/obj.h"

#include <cmath>
#include <iterator>

#include "core/base/error.h"
#include "engine/export/file_names.h"

namespace cei3d {
namespace {

std::string geometry_text(const Asset& asset, const Placement& placement, const std::string& library) {
  const TexturedMesh& mesh = asset.mesh;
  std::string out = fmt::format("mtllib {}\no object\nusemtl object\n", library);
  auto at = std::back_inserter(out);
  for (const Vec3f& point : mesh.positions) {
    const Vec3f p = to_float(placement(to_double(point)));
    fmt::format_to(at, "v {} {} {}\n", p.x, p.y, p.z);
  }
  for (const Vec2f& uv : mesh.uv) fmt::format_to(at, "vt {} {}\n", uv.x, 1 - uv.y);
  for (const Vec3f& normal : mesh.normals) {
    const Vec3f n = to_float(placement.turned(to_double(normal)));
    fmt::format_to(at, "vn {} {} {}\n", n.x, n.y, n.z);
  }
  for (const NamedTriangles& part : asset.parts) {
    fmt::format_to(at, "g {}\n", plain_name(part.name));
    for (const auto& t : part.triangles)
      fmt::format_to(at, "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return out;
}

}  // namespace

std::vector<FileBytes> obj_files(const Asset& asset, const Textures& textures,
                                 const std::filesystem::path& path, bool in_capture_frame) {
  const std::filesystem::path library = beside(path, ".mtl");
  std::string text =
      fmt::format("newmtl object\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 2\nNi {:.4f}\nPr 1\nPm 1\n",
                  index_of_refraction(asset.pictures));
  std::vector<FileBytes> out;
  const auto add = [&](const char* key, const Picture& picture) {
    out.push_back({beside(path, "_" + picture.name), picture.bytes});
    text += fmt::format("{} {}\n", key, uri_of(out.back().path));
  };
  add("map_Kd", asset.pictures.base_color);
  add("map_Pr", gray_picture(textures.orm, 1, "roughness"));
  add("map_Pm", gray_picture(textures.orm, 2, "metalness"));
  add("map_Ka", gray_picture(textures.orm, 0, "occlusion"));
  add("norm", asset.pictures.normal);
  out.push_back({library, text});
  const Placement placement = in_capture_frame ? Placement() : asset.placement;
  out.push_back({path, geometry_text(asset, placement, uri_of(library))});
  return out;
}

}  // namespace cei3d

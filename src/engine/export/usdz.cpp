// SPDX-License-Identifier: Apache-2.0
#include "engine/export/usdz.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/error.h"
#include "core/math/axis_box.h"

namespace cei3d {
namespace {

template <class T, class Format>
std::string list_of(const std::vector<T>& items, const Format& format) {
  std::string out = "[";
  for (size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out += ", ";
    format(std::back_inserter(out), items[i]);
  }
  return out + "]";
}

std::string vectors(const std::vector<Vec3f>& v) {
  return list_of(v, [](auto at, Vec3f p) { fmt::format_to(at, "({}, {}, {})", p.x, p.y, p.z); });
}

std::string extent(const std::vector<Vec3f>& v) {
  const AxisBox box = box_of(v);
  return vectors({box.min, box.max});
}

// Rows: where the axes go, then the origin; vectors are multiplied from the left.
std::string matrix_text(const Placement& p) {
  std::string out = "(";
  for (int a = 0; a < 3; ++a) {
    Vec3d axis{0, 0, 0};
    axis[a] = 1;
    const Vec3d row = p.turned(axis) * p.scale;
    out += fmt::format(" ({}, {}, {}, 0),", row.x, row.y, row.z);
  }
  return out + fmt::format(" ({}, {}, {}, 1) )", p.translation.x, p.translation.y, p.translation.z);
}

// Metadata stands on lines of its own, as some readers want it.
std::string mesh_text(const TexturedMesh& m) {
  const std::string counts = list_of(m.triangles, [](auto at, const auto&) { fmt::format_to(at, "3"); });
  const std::string indices = list_of(
      m.triangles, [](auto at, const auto& t) { fmt::format_to(at, "{}, {}, {}", t[0], t[1], t[2]); });
  const std::string st =
      list_of(m.uv, [](auto at, Vec2f uv) { fmt::format_to(at, "({}, {})", uv.x, 1 - uv.y); });
  return fmt::format(R"(    def Mesh "Surface" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {{
        float3[] extent = {}
        int[] faceVertexCounts = {}
        int[] faceVertexIndices = {}
        point3f[] points = {}
        normal3f[] normals = {} (
            interpolation = "vertex"
        )
        texCoord2f[] primvars:st = {} (
            interpolation = "vertex"
        )
        uniform token subdivisionScheme = "none"
        rel material:binding = </Root/Material>
    }}
)",
                     extent(m.positions), counts, indices, vectors(m.positions), vectors(m.normals), st);
}

// A shader that reads a picture. values: further inputs.
std::string texture_text(const std::string& name, const Picture& picture, const char* space,
                         const std::string& values, const std::string& outputs) {
  return fmt::format(R"(        def Shader "{}"
        {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @{}@
            token inputs:sourceColorSpace = "{}"
            float2 inputs:st.connect = </Root/Material/TextureCoordinates.outputs:result>
            token inputs:wrapS = "clamp"
            token inputs:wrapT = "clamp"
{}{}        }}
)",
                     name, picture.name, space, values, outputs);
}

std::string material_text(const AssetPictures& p) {
  const std::string
      rgb = "            float3 outputs:rgb\n",
      channels = "            float outputs:r\n            float outputs:g\n            float outputs:b\n",
      signed_values =
          "            float4 inputs:scale = (2, 2, 2, 1)\n            float4 inputs:bias = (-1, -1, -1, "
          "0)\n";
  return fmt::format(R"(    def Material "Material"
    {{
        token outputs:surface.connect = </Root/Material/Surface.outputs:surface>
        def Shader "Surface"
        {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </Root/Material/BaseColor.outputs:rgb>
            float inputs:occlusion.connect = </Root/Material/Packed.outputs:r>
            float inputs:roughness.connect = </Root/Material/Packed.outputs:g>
            float inputs:metallic.connect = </Root/Material/Packed.outputs:b>
            normal3f inputs:normal.connect = </Root/Material/Normal.outputs:rgb>
            float inputs:ior = {:.4f}
            int inputs:useSpecularWorkflow = 0
            token outputs:surface
        }}
        def Shader "TextureCoordinates"
        {{
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }}
)",
                     index_of_refraction(p)) +
         texture_text("BaseColor", p.base_color, "sRGB", "", rgb) +
         texture_text("Packed", p.orm, "raw", "", channels) +
         texture_text("Normal", p.normal, "raw", signed_values, rgb) + "    }\n";
}

std::string layer_text(const Asset& asset) {
  return "#usda 1.0\n(\n    defaultPrim = \"Root\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
         "def Xform \"Root\" (\n    kind = \"component\"\n)\n{\n"
         "    uniform token preliminary:anchoring:type = \"plane\"\n"
         "    matrix4d xformOp:transform = " +
         matrix_text(asset.placement) + "\n    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n\n" +
         mesh_text(asset.mesh) + material_text(asset.pictures) + "}\n";
}

}  // namespace

std::string encode_usdz(const Asset& asset) {
  const AssetPictures& p = asset.pictures;
  std::vector<FileBytes> files{{"model.usda", layer_text(asset)}};
  for (const Picture* picture : {&p.base_color, &p.orm, &p.normal})
    files.push_back({picture->name, picture->bytes});
  return stored_zip(files);
}

}  // namespace cei3d

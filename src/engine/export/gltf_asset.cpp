// SPDX-License-Identifier: Apache-2.0
#include "engine/export/gltf_asset.h"

#include <algorithm>
#include <functional>

#include "core/base/json.h"
#include "engine/export/file_names.h"
#include "engine/export/gltf_parts.h"

namespace cei3d {
namespace {

// Adds an image to the description; returns its entry.
using AddImage = std::function<Json(const Picture&)>;

class Description {
 public:
  Description(const Asset& asset, const AddImage& image)
      : asset_(asset), image_(image), json_(gltf_head(asset.name, asset.placement)) {}

  Json make(GltfBuffer& buffer) {
    add_meshes(buffer);
    const Json materials = Json::array({material()});
    json_["materials"] = materials;
    constexpr int kLinear = 9729, kTrilinear = 9987, kClamp = 33071;  // OpenGL's names for them
    json_["samplers"] = Json::array(
        {{{"magFilter", kLinear}, {"minFilter", kTrilinear}, {"wrapS", kClamp}, {"wrapT", kClamp}}});
    return std::move(json_);
  }

 private:
  // A mesh for every part, which share their vertices, at nodes below that of the object.
  void add_meshes(GltfBuffer& buffer) {
    const Json attributes = attributes_of(buffer);
    const bool single = asset_.parts.size() == 1;
    if (!single) json_["nodes"][0].erase("mesh");
    for (const NamedTriangles& part : asset_.parts) {
      const Json primitive{
          {"attributes", attributes}, {"indices", buffer.add_triangles(part.triangles)}, {"material", 0}};
      json_["meshes"].push_back({{"name", part.name}, {"primitives", Json::array({primitive})}});
      if (single) break;
      json_["nodes"][0]["children"].push_back(json_["nodes"].size());
      json_["nodes"].push_back({{"mesh", json_["meshes"].size() - 1}, {"name", part.name}});
    }
  }

  Json attributes_of(GltfBuffer& buffer) const {
    const TexturedMesh& m = asset_.mesh;
    std::vector<std::array<float, 4>> tangents;
    for (const Vec3f& t : m.tangents) tangents.push_back({t.x, t.y, t.z, 1});  // no chart is mirrored
    Json attributes;
    attributes["POSITION"] = buffer.add_positions(m.positions);
    attributes["NORMAL"] = buffer.add_vertices(m.normals.data(), m.normals.size(), 3, "VEC3");
    attributes["TANGENT"] = buffer.add_vertices(tangents.data(), tangents.size(), 4, "VEC4");
    attributes["TEXCOORD_0"] = buffer.add_vertices(m.uv.data(), m.uv.size(), 2, "VEC2");
    return attributes;
  }

  Json texture(const Picture& picture) {
    json_["images"].push_back(image_(picture));
    const size_t source = json_["images"].size() - 1;
    Json texture{{"sampler", 0}};
    if (picture.kind == PictureKind::webp) {  // not one of the core format's
      texture["extensions"]["EXT_texture_webp"] = {{"source", source}};
      require("EXT_texture_webp");
    } else {
      texture["source"] = source;
    }
    json_["textures"].push_back(texture);
    return {{"index", json_["textures"].size() - 1}};
  }

  // Readers that lack the extension refuse the file.
  void require(const char* extension) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      Json& list = json_[key];
      if (std::find(list.begin(), list.end(), extension) == list.end()) list.push_back(extension);
    }
  }

  Json material() {
    const AssetPictures& p = asset_.pictures;
    Json m{{"name", asset_.name}};
    const Json base = texture(p.base_color), orm = texture(p.orm);
    m["pbrMetallicRoughness"] = {{"baseColorTexture", base}, {"metallicRoughnessTexture", orm}};
    m["normalTexture"] = texture(p.normal);
    m["occlusionTexture"] = orm;
    if (!p.specular && p.middle_specular == 0.5f) return m;
    json_["extensionsUsed"].push_back("KHR_materials_specular");
    Json& extension = m["extensions"]["KHR_materials_specular"];
    extension = specular_extension(p.specular ? 1 : p.middle_specular);
    if (p.specular) extension["specularTexture"] = extension["specularColorTexture"] = texture(*p.specular);
    return m;
  }

  const Asset& asset_;
  const AddImage& image_;
  Json json_;
};

}  // namespace

std::string encode_glb(const Asset& asset) {
  GltfBuffer buffer;
  const AddImage image = [&](const Picture& p) {
    return Json{{"name", p.name}, {"mimeType", p.mime()}, {"bufferView", buffer.add_file(p.bytes)}};
  };
  Json description = Description(asset, image).make(buffer);
  return glb_of(std::move(description), std::move(buffer));
}

std::vector<FileBytes> gltf_files(const Asset& asset, const std::filesystem::path& path) {
  GltfBuffer buffer;
  std::vector<FileBytes> out;
  const AddImage image = [&](const Picture& p) {
    out.push_back({beside(path, "_" + p.name), p.bytes});
    return Json{{"name", p.name}, {"uri", uri_of(out.back().path)}};
  };
  Json description = Description(asset, image).make(buffer);
  const std::filesystem::path bin = beside(path, ".bin");
  buffer.describe(description, uri_of(bin));
  out.push_back({bin, buffer.take_bytes()});
  out.push_back({path, description.dump(1)});
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "engine/io/ply.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

uint8_t to_byte(float linear) {
  const float v = srgb_from_linear(linear);
  return v > 0 ? uint8_t(std::min(v, 1.0f) * 255 + 0.5f) : 0;
}

std::string declared(const PlyProperty& p) {
  return fmt::format("property {} {}\n", p.values.index() == 0 ? "uchar" : "float", p.name);
}

struct Property {
  std::string name, type, count_type;  // count_type: of a list, else empty
};
struct Element {
  std::string name;
  size_t count = 0;
  std::vector<Property> properties;
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  [[noreturn]] void broken(const std::string& why) const {
    fail("{} is not a usable PLY mesh: {}.", name_, why);
  }

  std::string line() {
    const size_t end = bytes_.find('\n', position_);
    if (end == std::string::npos) broken("its header does not end");
    std::string text = bytes_.substr(position_, end - position_);
    if (!text.empty() && text.back() == '\r') text.pop_back();
    position_ = end + 1;
    return text;
  }
  double number(const std::string& type) {
    if (type == "float" || type == "float32") return take<float>();
    if (type == "double" || type == "float64") return take<double>();
    if (type == "uchar" || type == "uint8") return take<uint8_t>();
    if (type == "char" || type == "int8") return take<int8_t>();
    if (type == "ushort" || type == "uint16") return take<uint16_t>();
    if (type == "short" || type == "int16") return take<int16_t>();
    if (type == "uint" || type == "uint32") return take<uint32_t>();
    if (type == "int" || type == "int32") return take<int32_t>();
    broken("unknown type '" + type + "'");
  }
  size_t left() const { return bytes_.size() - position_; }

 private:
  template <class T>
  double take() {
    if (left() < sizeof(T)) broken("it ends too early");
    T value;
    std::memcpy(&value, bytes_.data() + position_, sizeof value);
    position_ += sizeof value;
    return double(value);
  }
  const std::string& bytes_;
  const std::string& name_;
  size_t position_ = 0;
};

std::vector<Element> read_header(Reader& in) {
  if (in.line() != "ply") in.broken("it does not start with 'ply'");
  std::vector<Element> elements;
  for (std::string text = in.line(); text != "end_header"; text = in.line()) {
    std::istringstream words(text);
    std::string word, a, b;
    words >> word;
    if (word == "format") {
      words >> a;
      if (a != "binary_little_endian") in.broken("its format is " + a + "; save it as binary little endian");
    } else if (word == "element") {
      Element& e = elements.emplace_back();
      if (!(words >> e.name >> e.count)) in.broken("its header is malformed");
    } else if (word == "property") {
      if (elements.empty() || !(words >> a)) in.broken("its header is malformed");
      Property p;
      if (a == "list")
        words >> p.count_type >> p.type >> p.name;
      else
        p.type = a, words >> p.name;
      if (p.name.empty()) in.broken("its header is malformed");
      elements.back().properties.push_back(p);
    }
  }
  for (const Element& e :
       elements)  // every item takes a byte at least, so that hostile counts allocate nothing
    if (e.properties.empty() ? e.count > 0 : e.count > in.left()) in.broken("it ends too early");
  return elements;
}

// Member of the mesh and component that a scalar property is stored to; -1: skipped.
int target_of(const std::string& name) {
  const char* names[] = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"};
  for (int i = 0; i < 9; ++i)
    if (name == names[i]) return i;
  return -1;
}

void skip_list(Reader& in, const Property& p) {
  const double n = in.number(p.count_type);
  for (double i = 0; i < n; ++i) in.number(p.type);
}

void read_vertices(Reader& in, const Element& e, Mesh& mesh) {
  bool has[9] = {};
  for (const Property& p : e.properties)
    if (p.count_type.empty() && target_of(p.name) >= 0) has[target_of(p.name)] = true;
  if (!has[0] || !has[1] || !has[2]) in.broken("its vertices have no x, y, z");
  for (size_t i = 0; i < e.count; ++i) {
    Vec3f v[3] = {};
    for (const Property& p : e.properties) {
      if (!p.count_type.empty()) {
        skip_list(in, p);
        continue;
      }
      const double value = in.number(p.type);
      const int t = target_of(p.name);
      if (t >= 6)
        v[2][t - 6] = linear_from_srgb(float(p.type[0] == 'u' ? value / 255 : value));
      else if (t >= 0)
        v[t / 3][t % 3] = float(value);
    }
    if (!std::isfinite(dot(v[0], v[0]))) in.broken("a vertex is not finite");
    mesh.positions.push_back(v[0]);
    if (has[3] && has[4] && has[5]) mesh.normals.push_back(v[1]);
    if (has[6] && has[7] && has[8]) mesh.colors.push_back(v[2]);
  }
}

void read_faces(Reader& in, const Element& e, Mesh& mesh) {
  for (size_t i = 0; i < e.count; ++i)
    for (const Property& p : e.properties) {
      if (p.count_type.empty()) {
        in.number(p.type);
      } else if (p.name != "vertex_indices" && p.name != "vertex_index") {
        skip_list(in, p);
      } else {
        const double n = in.number(p.count_type);
        uint32_t first = 0, last = 0;
        for (double k = 0; k < n; ++k) {
          const double index = in.number(p.type);
          if (!(index >= 0 && index < double(mesh.positions.size())))
            in.broken("a face names a vertex that does not exist");
          if (k >= 2) mesh.triangles.push_back({first, last, uint32_t(index)});
          if (k == 0) first = uint32_t(index);
          last = uint32_t(index);
        }
      }
    }
}

}  // namespace

std::string encode_ply(const Mesh& mesh, const PlyExtras& extras) {
  const bool normals = mesh.normals.size() == mesh.positions.size(),
             colors = mesh.colors.size() == mesh.positions.size();
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment CEI-3D\n";
  for (const std::string& line : extras.comments) out += "comment " + line + "\n";
  out += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
                     mesh.positions.size());
  if (normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
  if (colors) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  for (const PlyProperty& p : extras.properties) out += declared(p);
  out += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                     mesh.triangles.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    append_bytes(out, mesh.positions[i]);
    if (normals) append_bytes(out, mesh.normals[i]);
    for (int c = 0; colors && c < 3; ++c) append_bytes(out, to_byte(mesh.colors[i][c]));
    for (const PlyProperty& p : extras.properties)
      std::visit([&](const auto& values) { append_bytes(out, values[i]); }, p.values);
  }
  for (const auto& t : mesh.triangles) {
    append_bytes(out, uint8_t(3));
    append_bytes(out, t);
  }
  return out;
}

void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  write_file_atomic(path, encode_ply(mesh));
}

Mesh decode_ply(const std::string& bytes, const std::string& name) {
  Reader in(bytes, name);
  Mesh mesh;
  for (const Element& e : read_header(in)) {
    if (e.name == "vertex")
      read_vertices(in, e, mesh);
    else if (e.name == "face")
      read_faces(in, e, mesh);
    else
      for (size_t i = 0; i < e.count; ++i)
        for (const Property& p : e.properties)
          p.count_type.empty() ? void(in.number(p.type)) : skip_list(in, p);
  }
  return mesh;
}

Mesh read_ply(const std::filesystem::path& path) { return decode_ply(read_file(path), path.string()); }

}  // namespace cei3d

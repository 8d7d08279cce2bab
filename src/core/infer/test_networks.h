// SPDX-License-Identifier: Apache-2.0
// Tests only: small networks as the bytes of an ONNX file, by writing its protocol buffers by hand. Fields:
// onnx.proto.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cei3d::test_networks {

inline std::string varint(uint64_t value) {
  std::string out;
  for (; value > 127; value >>= 7) out += char(value | 128);
  return out + char(value);
}
inline std::string number(int field, uint64_t value) { return varint(uint64_t(field) << 3) + varint(value); }
inline std::string bytes(int field, const std::string& s) {
  return varint(uint64_t(field) << 3 | 2) + varint(s.size()) + s;
}

// A tensor of floats with free sizes, "d0", "d1", ... of its own: an input or output of the network.
inline std::string float_tensor(const std::string& name, int dimensions) {
  std::string shape;
  for (int d = 0; d < dimensions; ++d) shape += bytes(1, bytes(2, name + std::to_string(d)));
  return bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, shape)));
}

inline std::string attribute(const std::string& name, const std::vector<int>& values) {
  std::string a = bytes(1, name) + number(20, 7);  // of kind INTS
  for (const int v : values) a += number(8, uint64_t(v));
  return bytes(5, a);
}

// attributes: a sum of attribute().
inline std::string node(const std::string& op, const std::vector<std::string>& inputs,
                        const std::string& output, const std::string& attributes = "") {
  std::string n;
  for (const std::string& i : inputs) n += bytes(1, i);
  return bytes(1, n + bytes(2, output) + bytes(4, op) + attributes);
}

// nodes: a sum of node(); inputs, outputs: of float_tensor().
inline std::string network(const std::string& nodes, const std::vector<std::string>& inputs,
                           const std::vector<std::string>& outputs) {
  std::string graph = nodes + bytes(2, "g");
  for (const std::string& i : inputs) graph += bytes(11, i);
  for (const std::string& o : outputs) graph += bytes(12, o);
  return number(1, 7) + bytes(7, graph) + bytes(8, bytes(1, "") + number(2, 13));
}

// Two images [1, C, H, W] -> their mean squared difference, [1, 1, 1, 1].
inline std::string squared_distance() {
  return network(node("Sub", {"a", "b"}, "d") + node("Mul", {"d", "d"}, "q") +
                     node("ReduceMean", {"q"}, "c", attribute("axes", {1, 2, 3})),
                 {float_tensor("a", 4), float_tensor("b", 4)}, {float_tensor("c", 4)});
}

// An image [1, C, H, W] -> the means of its channels, [1, C, 1, 1].
inline std::string channel_means() {
  return network(node("ReduceMean", {"x"}, "m", attribute("axes", {2, 3})), {float_tensor("x", 4)},
                 {float_tensor("m", 4)});
}

}  // namespace cei3d::test_networks

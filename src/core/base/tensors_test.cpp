// SPDX-License-Identifier: Apache-2.0
#include "core/base/tensors.h"

#include <gmock/gmock.h>

#include <cstring>
#include <random>

#include "core/base/error.h"
#include "core/base/error_of.h"
#include "core/base/temp_folder.h"

namespace cei3d {
namespace {

Tensors sample() {
  Tensors t;
  t["empty"] = {{0, 3}, {}, {}};
  t["mask"] = {{5}, {}, {1, 2, 3, 4, 255}};
  t["sdf/layer0/weight"] = {{2, 3}, {0, -1.5f, 1e-30f, 3, 4, 5}, {}};
  t["scalar"] = {{}, {7}, {}};
  return t;
}

std::string with_header(const std::string& header, const std::string& data = {}) {
  const uint64_t n = header.size();
  return std::string(reinterpret_cast<const char*>(&n), 8) + header + data;
}

void expect_equal(const Tensors& a, const Tensors& b) {
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, t] : a) {
    ASSERT_TRUE(b.count(name)) << name;
    EXPECT_EQ(t.shape, b.at(name).shape);
    EXPECT_EQ(t.f32, b.at(name).f32);
    EXPECT_EQ(t.u8, b.at(name).u8);
  }
}

TEST(Tensors, RoundTripThroughAFile) {
  const TempFolder temp;
  write_tensors(temp.path() / "t.safetensors", sample());
  expect_equal(read_tensors(temp.path() / "t.safetensors"), sample());
  expect_equal(tensors_from_bytes(tensors_to_bytes({}), "t"), {});
}

// The example of the format's own description, byte for byte.
TEST(Tensors, ReadsAForeignFile) {
  const std::string data = std::string("\0\0\x80\x3f", 4) + "ab";
  const Tensors t = tensors_from_bytes(
      with_header(R"({"__metadata__":{"format":"pt"},"x":{"dtype":"F32","shape":[1,1],"data_offsets":[0,4]},)"
                  R"("y":{"dtype":"U8","shape":[2],"data_offsets":[4,6]}}   )",
                  data),
      "t");
  EXPECT_EQ(t.at("x").f32, std::vector<float>{1});
  EXPECT_EQ(t.at("y").u8, (std::vector<uint8_t>{'a', 'b'}));
}

TEST(Tensors, ARequiredArrayIsThereAsItIsWanted) {
  const Tensors t = sample();
  EXPECT_EQ(&require_tensor(t, "mask"), &t.at("mask"));
  EXPECT_EQ(&require_tensor(t, "sdf/layer0/weight", {2, 3}), &t.at("sdf/layer0/weight"));
  EXPECT_EQ(&require_tensor(t, "scalar", {}), &t.at("scalar"));
  EXPECT_EQ(&require_bytes(t, "mask", {5}), &t.at("mask"));
  for (const auto& require : {require_bytes, static_cast<decltype(&require_bytes)>(require_tensor)})
    EXPECT_EQ(&require(t, "empty", {0, 3}), &t.at("empty"));
}

TEST(Tensors, ARequiredArrayThatIsMissingOrAnotherIsAnError) {
  const auto floats = [](const char* name, std::vector<int64_t> shape) {
    return message([&] { require_tensor(sample(), name, shape); });
  };
  EXPECT_THAT(message([] { require_tensor(sample(), "normal"); }), testing::HasSubstr("'normal' is missing"));
  EXPECT_THAT(floats("normal", {5}), testing::HasSubstr("'normal' is missing"));
  EXPECT_THAT(floats("sdf/layer0/weight", {3, 2}), testing::HasSubstr("has the shape 2x3 instead of 3x2"));
  EXPECT_THAT(floats("sdf/layer0/weight", {6}), testing::HasSubstr("has the shape 2x3 instead of 6"));
  EXPECT_THAT(floats("mask", {5}), testing::HasSubstr("holds bytes instead of floats"));
  EXPECT_THAT(message([] {
                require_bytes(sample(), "sdf/layer0/weight", {2, 3});
              }),
              testing::HasSubstr("holds floats instead of bytes"));
}

TEST(Tensors, BadHeadersAreErrors) {
  const auto x = [](const std::string& body, size_t bytes = 8) {
    return with_header("{\"x\":" + body + "}", std::string(bytes, '\0'));
  };
  const std::vector<std::string> bad = {
      "",
      "short",
      std::string(8, '\xff'),
      with_header("[]"),
      with_header("nonsense"),
      with_header(std::string(100000, '[')),
      with_header("{\"x\":" + std::string(1000, '[') + std::string(1000, ']') + "}"),
      x("1"),
      x(R"({"dtype":"F32","shape":[2]})"),
      x(R"({"dtype":"F64","shape":[1],"data_offsets":[0,8]})"),
      x(R"({"dtype":7,"shape":[2],"data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":[3],"data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":[-2],"data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":[2.0],"data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":"2","data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":[4294967296,4294967296],"data_offsets":[0,8]})"),
      x(R"({"dtype":"F32","shape":[4611686018427387906],"data_offsets":[0,8]})"),  // 4 n overflows to 8
      x(R"({"dtype":"F32","shape":[2],"data_offsets":[8,0]})"),
      x(R"({"dtype":"F32","shape":[2],"data_offsets":[4,12]})"),
      x(R"({"dtype":"F32","shape":[2],"data_offsets":[0,18446744073709551615]})"),
      x(R"({"dtype":"F32","shape":[2],"data_offsets":[0]})"),
      x(R"({"dtype":"F32","shape":[1],"data_offsets":[4,8]})"),  // a gap
      x(R"({"dtype":"F32","shape":[1],"data_offsets":[0,4]})"),  // bytes after
      x(R"({"dtype":"U8","shape":[6],"data_offsets":[0,6]},"y":{"dtype":"U8","shape":[4],"data_offsets":[4,8]})"),
  };
  for (const std::string& bytes : bad)
    EXPECT_THROW(tensors_from_bytes(bytes, "bad.safetensors"), Error) << bytes.substr(0, 200);
}

TEST(Tensors, EveryTruncationIsAnErrorThatNamesTheFile) {
  const std::string bytes = tensors_to_bytes(sample());
  for (size_t n = 0; n < bytes.size(); ++n) {
    try {
      tensors_from_bytes(bytes.substr(0, n), "cut.safetensors");
      FAIL() << "accepted at " << n;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("cut.safetensors"));
    }
  }
}

TEST(Tensors, FlippedBytesNeverCrash) {
  const std::string bytes = tensors_to_bytes(sample());
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string s = bytes;
    for (int k = 0; k < 3; ++k) s[random() % s.size()] = char(random());
    try {
      tensors_from_bytes(s, "x");
    } catch (const Error&) {
    }
  }
}

TEST(Tensors, InconsistentShapeIsRefused) {
  Tensors t;
  t["x"] = {{3}, {1, 2}, {}};
  EXPECT_THROW(tensors_to_bytes(t), Error);
}

}  // namespace
}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
#include "core/infer/onnx.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/base/test_source.h"
#include "core/infer/test_networks.h"

namespace cei3d {
namespace {

// `./run sam` fills it; tests run in the repository's root.
const std::filesystem::path kFolder = source_file("build/sam");

// c = a - b
std::string subtraction() {
  using namespace test_networks;
  return network(node("Sub", {"a", "b"}, "c"), {float_tensor("a", 1), float_tensor("b", 1)},
                 {float_tensor("c", 1)});
}

// First: a library that is open already would be found under its name.
TEST(OnnxMissing, SaysWhatToInstall) {
  if (OnnxRuntime::available("nowhere")) GTEST_SKIP() << "the system has an ONNX Runtime of its own";
  try {
    OnnxRuntime runtime("nowhere");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("./run sam"), std::string::npos);
  }
}

class Onnx : public testing::Test {
 protected:
  void SetUp() override {
    if (!OnnxRuntime::available(kFolder)) GTEST_SKIP() << "no ONNX Runtime here; ./run sam installs it";
  }
  std::shared_ptr<const OnnxModel> model(const std::string& content) {
    const auto file = folder_.path() / "network.onnx";
    write_file_atomic(file, content);
    return std::make_shared<OnnxModel>(std::make_shared<OnnxRuntime>(kFolder), file, 1);
  }
  TempFolder folder_;
};

TEST_F(Onnx, RunsAnExpressionWhoseValueIsKnown) {
  const auto m = model(subtraction());
  EXPECT_EQ(m->inputs(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(m->outputs(), std::vector<std::string>{"c"});
  const OnnxTensors out = m->run({{"a", {{3}, {5, 7, 9}}}, {"b", {{3}, {1, 10, 0.5f}}}}, {"c"});
  EXPECT_EQ(out.at("c").shape, std::vector<int64_t>{3});
  EXPECT_EQ(out.at("c").data, (std::vector<float>{4, -3, 8.5f}));
}

TEST_F(Onnx, RefusesWhatDoesNotFit) {
  const auto m = model(subtraction());
  EXPECT_THROW(m->run({{"a", {{1}, {1}}}}, {"c"}), Error);                        // no b
  EXPECT_THROW(m->run({{"a", {{2}, {1}}}, {"b", {{1}, {1}}}}, {"c"}), Error);     // shape without its data
  EXPECT_THROW(m->run({{"a", {{1, 1}, {1}}}, {"b", {{1}, {1}}}}, {"c"}), Error);  // another rank
  EXPECT_THROW(m->run({{"a", {{1}, {1}}}, {"b", {{1}, {1}}}}, {"d"}), Error);     // no such output
}

TEST_F(Onnx, FileThatIsNoNetwork) {
  EXPECT_THROW(model("this is text"), Error);
  EXPECT_THROW(model(""), Error);
  const auto runtime = std::make_shared<OnnxRuntime>(kFolder);
  EXPECT_THROW(OnnxModel(runtime, folder_.path() / "missing.onnx"), Error);
}

}  // namespace
}  // namespace cei3d

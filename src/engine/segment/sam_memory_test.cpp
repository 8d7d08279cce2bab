// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/sam_memory.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cei3d {
namespace {

TEST(EncodedImages, AreEncodedOnceAndTheLongestUnusedGoesFirst) {
  EncodedImages images;
  std::vector<float> encoded;  // first values of the images that were encoded
  const EncodedImages::Encode encode = [&](const Image& image) {
    encoded.push_back(image.data[0]);
    return SamImage{{}, image.width, image.height};
  };
  const auto get = [&](float value, int width) { return images.get(Image(width, 2, 4, value), encode); };
  EXPECT_EQ(get(0, 3)->width, 3);
  EXPECT_EQ(get(0, 3)->width, 3);
  EXPECT_EQ(encoded.size(), 1u);
  EXPECT_EQ(get(0, 4)->width, 4);  // the same value, another size
  for (size_t i = 1; i < EncodedImages::kMax - 1; ++i) get(float(i), 3);
  get(0, 3);  // used again: the image of width 4 is the oldest now
  encoded.clear();
  get(1000, 3);
  get(0, 3);
  EXPECT_EQ(encoded, std::vector<float>{1000});
  get(0, 4);
  EXPECT_EQ(encoded, (std::vector<float>{1000, 0}));
}

TEST(SamMemory, WithoutNetworksSaysWhatToDo) {
  SamMemory memory("nowhere");
  try {
    memory.encoded(Image(4, 4, 4));
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("./run sam"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace cei3d

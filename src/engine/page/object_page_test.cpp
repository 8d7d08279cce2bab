// SPDX-License-Identifier: Apache-2.0
#include "engine/page/object_page.h"

#include <gtest/gtest.h>

#include "core/base/json.h"
#include "engine/page/page_files.h"

namespace cei3d {
namespace {

size_t count(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Base64, IsThatOfTheStandard) {  // [RFC 4648, sec. 10]
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\xfe\0", 3)), "//4A");
}

TEST(ObjectPage, HoldsEverythingAndLoadsNothing) {
  const std::string page = object_page("spot", {{"up", {0, 0, 1}}}, {{"shape", std::string(100, 'x')}});
  for (const char* key : {"policy", "name", "style", "data", "script"})
    EXPECT_EQ(count(page, "{{" + std::string(key) + "}}"), 0u) << key;
  EXPECT_EQ(count(page, "<script type=\"module\">"), 1u);
  EXPECT_EQ(count(page, "</script>"), 3u);
  EXPECT_EQ(count(page, "default-src 'none'; script-src 'sha256-"), 1u);
  EXPECT_EQ(count(page, "unsafe"), 0u);
  EXPECT_EQ(count(page, "\nimport "), 0u);
  EXPECT_EQ(count(page, "\nexport "), 0u);
  for (const char* loads : {"http:", "https:", "src=", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(count(page, loads), 0u);
}

TEST(ObjectPage, NamesAreText) {
  const std::string page = object_page("</title><script>alert(1)</script>&\"", {{"x", "</script>"}}, {});
  EXPECT_EQ(count(page, "alert(1)</script>"), 0u);
  EXPECT_EQ(count(page, "<title>&lt;/title&gt;&lt;script&gt;"), 1u);
  EXPECT_EQ(count(page, "</script>"), 2u);
}

TEST(PageFiles, EveryModuleIsThere) {
  for (const char* name : {"renderer.js", "camera.js", "page.html", "page.css", "page.joined.js"})
    EXPECT_FALSE(page_file(name).bytes.empty()) << name;
}

}  // namespace
}  // namespace cei3d

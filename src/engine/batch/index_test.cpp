// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "engine/batch/csv.h"
#include "engine/io/png_file.h"

namespace cei3d {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

std::string id_of(int i) { return fmt::format("o{}", i); }

// All that stands between `begin` and `end`, in order.
std::vector<std::string> all_between(const std::string& text, const std::string& begin,
                                     const std::string& end) {
  std::vector<std::string> out;
  for (size_t at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
    at += begin.size();
    out.push_back(text.substr(at, text.find(end, at) - at));
  }
  return out;
}

// The file that a relative address of a page means, as a browser decodes it.
fs::path file_of(const fs::path& page, const std::string& address) {
  std::string path;
  for (size_t i = 0; i < address.size(); ++i)
    if (address[i] == '%') {
      path += char(std::stoi(address.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      path += address[i];
    }
  return page.parent_path() / path;
}

// A catalog whose folder needs an escape in addresses; objects are as a worker would have left them.
class BatchIndexTest : public testing::Test {
 protected:
  BatchIndexTest() { fs::create_directories(catalog.folder()); }

  void ended(const std::string& id, BatchOutcome outcome, const Json& result,
             const std::string& reason = "") {
    const auto attempt = BatchAttempt::take(catalog.folder(), id, {1000, 1000});
    BatchState s;
    s.outcome = outcome;
    s.reason = reason;
    s.attempt = attempt->number();
    s.result = result;
    attempt->publish_state(s);
  }

  // Its thumbnail has the gray value `psnr_worst`.
  void done(const std::string& id, int psnr_worst) {
    const fs::path item = batch_item_folder(catalog.folder(), id);
    write_file_atomic(item / "figures" / "thumbnail.png",
                      encode_png(Image(4, 4, 3, float(psnr_worst) / 255), 8));
    write_file_atomic(item / "export" / "original" / (id + ".html"), "viewer of " + id);
    ended(id, BatchOutcome::done,
          {{"check", {{"views", 20}, {"warnings", {"Masks <touch> the \"edge\" & more"}}}},
           {"figures", {{"psnr", psnr_worst + 2}, {"psnr_worst", psnr_worst}, {"worst_view", "test/<7>"}}},
           {"export/original", {{"files", {id + ".glb", id + ".html"}}}}});
  }

  std::string index(const std::string& name) {
    write_batch_index(catalog, BatchManifest::of(lines), folder.path() / name);
    return read_file(folder.path() / name);
  }

  TempFolder folder;
  BatchCatalog catalog{folder.path() / "shoes & 50%"};
  std::vector<Json> lines;
};

TEST_F(BatchIndexTest, ThumbnailsAndViewersAreThoseOfTheirObjectsWorstFirst) {
  const std::vector<int> figures{31, 24, 40, 27};
  for (size_t i = 0; i < figures.size(); ++i) {
    lines.push_back({{"id", id_of(int(i))}, {"capture", "c"}});
    done(id_of(int(i)), figures[i]);
  }
  lines.push_back({{"id", "bad"}, {"capture", "c"}, {"tags", {{"<shelf>", "a&b"}}}});
  ended("bad", BatchOutcome::failed, Json::object(), "No <mask> is & was there.");
  lines.push_back({{"id", "open"}, {"capture", "c"}});

  const std::string page = index("catalog.html");
  EXPECT_THAT(all_between(page, "<tr id=\"", "\""), ElementsAre("bad", "o1", "o3", "o0", "o2", "open"));
  const std::vector<std::string> images = all_between(page, "src=\"", "\"");
  ASSERT_EQ(images.size(), figures.size());
  std::vector<int> grays;
  for (const std::string& address : images) {
    const Image picture = decode_png(read_file(file_of(folder.path() / "catalog.html", address)), address);
    grays.push_back(int(std::lround(255 * picture.data[0])));
  }
  EXPECT_THAT(grays, ElementsAre(24, 27, 31, 40));
  std::vector<std::string> viewers;
  for (const std::string& address : all_between(page, "<td><a href=\"", "\"><img"))
    viewers.push_back(read_file(file_of(folder.path() / "catalog.html", address)));
  EXPECT_THAT(viewers, ElementsAre("viewer of o1", "viewer of o3", "viewer of o0", "viewer of o2"));

  // Nothing that people wrote is a tag.
  EXPECT_THAT(page, Not(testing::ContainsRegex("<mask|<touch|<shelf|<7")));
  EXPECT_THAT(page, HasSubstr("No &lt;mask&gt; is &amp; was there."));
  EXPECT_THAT(page, HasSubstr("Masks &lt;touch&gt; the &quot;edge&quot; &amp; more"));
  EXPECT_THAT(page, HasSubstr("test/&lt;7&gt;"));
  EXPECT_THAT(page, HasSubstr("&lt;shelf&gt;: a&amp;b"));
}

TEST_F(BatchIndexTest, AnObjectWithoutFiguresIsShownByItsTurntable) {
  lines.push_back({{"id", "o0"}, {"capture", "c"}});
  ended("o0", BatchOutcome::done, {{"turntable/original", {{"picture", "rgb/000.png"}}}});
  EXPECT_THAT(all_between(index("i.html"), "src=\"", "\""),
              testing::Contains(testing::EndsWith("/o0/turntable/original/rgb/000.png")));
}

TEST_F(BatchIndexTest, PagesHaveEveryObjectOnceAndNameEachOther) {
  constexpr int kObjects = 1203;
  for (int i = 0; i < kObjects; ++i) lines.push_back({{"id", id_of(i)}, {"steps", {"stub"}}});
  const std::string first = index("i.html");
  const std::vector<std::string> pages =
      all_between(all_between(first, "<nav>", "</nav>").at(0), "href=\"", "\"");
  EXPECT_THAT(pages, ElementsAre("i.html", "i-2.html", "i-3.html"));
  std::multiset<std::string> found, expected;
  for (const std::string& page : pages)
    for (const std::string& id : all_between(read_file(folder.path() / page), "<tr id=\"", "\""))
      found.insert(id);
  for (int i = 0; i < kObjects; ++i) expected.insert(id_of(i));
  EXPECT_EQ(found, expected);
}

TEST_F(BatchIndexTest, TablesHaveTheSameRowsAndTags) {
  lines = {{{"id", "o0"}, {"capture", "c"}, {"tags", {{"price", 12}}}},
           {{"id", "o1"}, {"capture", "c"}, {"tags", {{"shelf", "a, b"}}}}};
  done("o0", 30);
  ended("o1", BatchOutcome::failed, Json::object(), "Said \"no\",\nand why.");
  const auto table = csv_table(index("i.csv"), "t");
  const auto column = [&](const std::string& name) {
    const auto& head = table.at(0);
    const auto at = size_t(std::find(head.begin(), head.end(), name) - head.begin());
    return std::vector<std::string>{table.at(1).at(at), table.at(2).at(at)};
  };
  EXPECT_THAT(column("id"), ElementsAre("o1", "o0"));
  EXPECT_THAT(column("sentence"), ElementsAre("Said \"no\",\nand why.", ""));
  EXPECT_THAT(column("psnr_worst"), ElementsAre("", "30"));
  EXPECT_THAT(column("thumbnail"), ElementsAre("", "figures/thumbnail.png"));
  EXPECT_THAT(column("tag.price"), ElementsAre("", "12"));
  EXPECT_THAT(column("tag.shelf"), ElementsAre("a, b", ""));

  const Json rows = Json::parse(index("i.json"));
  EXPECT_EQ(rows.at(1).at("files").at("original").at(1), "export/original/o0.html");
  EXPECT_EQ(error_of([&] { index("i.pdf"); }).code(), ErrorCode::usage);
}

}  // namespace
}  // namespace cei3d

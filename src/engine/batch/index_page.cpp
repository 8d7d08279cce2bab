// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/index_page.h"

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/html.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr size_t kRowsOnAPage = 500;

constexpr const char* kHead =
    R"(<!doctype html><html lang="en"><meta charset="utf-8"><title>{0}</title><style>
body{{font:14px/1.4 sans-serif;margin:1.5em;color:#222}}
table{{border-collapse:collapse}}th,td{{padding:.3em .7em;text-align:left;vertical-align:top}}
th{{position:sticky;top:0;background:#fff}}tr+tr{{border-top:1px solid #ddd}}td.n{{text-align:right}}
img{{width:96px;height:96px;background:#eee}}.failed{{color:#b00}}small{{color:#555}}nav a{{margin-right:.6em}}
</style><h1>{0}</h1>
)";

// A path as an address.
std::string address(const fs::path& path) {
  std::string out;
  for (const unsigned char c : path.generic_string())
    out += std::isalnum(c) || std::string("/._-~").find(char(c)) != std::string::npos
               ? std::string(1, char(c))
               : fmt::format("%{:02X}", c);
  return out;
}

std::string number(const Json& j, int digits) {
  return j.is_number() ? fmt::format("{:.{}f}", j.get<double>(), digits) : "";
}

fs::path page_file(const fs::path& out, size_t page) {
  if (page == 0) return out;
  return out.parent_path() / fmt::format("{}-{}{}", out.stem().string(), page + 1, out.extension().string());
}

constexpr const char* kViewerPage = ".html";

std::string links(const Json& row, const fs::path& folder) {
  std::string out;
  for (const auto& [variant, files] : row.at("files").items()) {
    out += html_escaped(variant) + ":";
    for (const Json& file : files) {
      const fs::path path = file.get<std::string>(), ending = path.extension();
      const std::string kind = ending == kViewerPage ? "view" : ending.string();
      out += fmt::format(" <a href=\"{}\">{}</a>", address(folder / path),
                         html_escaped(kind.starts_with(".") ? kind.substr(1) : kind));
    }
    out += "<br>";
  }
  return out;
}

std::string remarks(const Json& row) {
  std::string out;
  if (const std::string sentence = row.at("sentence"); !sentence.empty())
    out += fmt::format("<span class=\"{}\">{}</span><br>", row.at("state").get<std::string>(),
                       html_escaped(sentence));
  for (const Json& w : row.at("warnings")) out += html_escaped(w.get<std::string>()) + "<br>";
  for (const auto& [name, value] : row.at("tags").items())
    out += fmt::format("<small>{}: {}</small><br>", html_escaped(name),
                       html_escaped(value.is_string() ? value.get<std::string>() : value.dump()));
  return out;
}

// The thumbnail leads to the object's viewer page, where there is one.
std::string picture(const Json& row, const fs::path& folder) {
  if (!row.at("thumbnail").is_string()) return "";
  const std::string image = fmt::format("<img loading=\"lazy\" alt=\"{}\" src=\"{}\">",
                                        html_escaped(row.at("id").get<std::string>()),
                                        address(folder / row.at("thumbnail").get<std::string>()));
  for (const auto& [variant, files] : row.at("files").items())
    for (const Json& file : files)
      if (const fs::path path = file.get<std::string>(); path.extension() == kViewerPage)
        return fmt::format("<a href=\"{}\">{}</a>", address(folder / path), image);
  return image;
}

// The figure of the worst view, and which one it is.
std::string worst(const Json& row) {
  std::string out = number(row.at("psnr_worst"), 1);
  if (row.at("worst_view").is_string() && !out.empty())
    out += fmt::format("<br><small>{}</small>", html_escaped(row.at("worst_view").get<std::string>()));
  return out;
}

std::string table_row(const Json& row, const fs::path& page_folder) {
  const fs::path folder = fs::path(row.at("folder").get<std::string>()).lexically_relative(page_folder);
  const std::string id = html_escaped(row.at("id")), state = row.at("state");
  return fmt::format(
      "<tr id=\"{}\"><td>{}<td><b>{}</b><br><small>{}</small><td class=\"{}\">{}<td class=n>{}"
      "<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}<td>{}<td>{}</tr>\n",
      id, picture(row, folder), id, row.at("material").is_string() ? html_escaped(row.at("material")) : "",
      state, state, worst(row), number(row.at("psnr"), 1), number(row.at("psnr_alone"), 1),
      number(row.at("vertices"), 0), number(row.at("seconds"), 0), links(row, folder), remarks(row));
}

std::string summary(const std::vector<Json>& rows) {
  std::map<std::string, size_t> counts;
  for (const Json& row : rows) ++counts[row.at("state").get<std::string>()];
  std::string out = fmt::format("<p>{} objects", rows.size());
  for (const auto& [state, n] : counts) out += fmt::format(", {} {}", n, state);
  return out + ".</p>\n";
}

std::string page_list(size_t pages, const fs::path& out) {
  if (pages == 1) return "";
  std::string list = "<nav>";
  for (size_t p = 0; p < pages; ++p)
    list += fmt::format("<a href=\"{}\">{}</a>", address(page_file(out, p).filename()), p + 1);
  return list + "</nav>\n";
}

}  // namespace

void write_index_pages(const std::vector<Json>& rows, const fs::path& catalog, const fs::path& out) {
  const size_t pages = std::max<size_t>(1, (rows.size() + kRowsOnAPage - 1) / kRowsOnAPage);
  const fs::path folder = fs::absolute(out).lexically_normal().parent_path();
  const std::string top =
      fmt::format(kHead, "Catalog " + html_escaped(catalog.filename().string())) + summary(rows) +
      page_list(pages, out) +
      "<table><tr><th><th>object<th>state<th>worst view, dB<th>PSNR, dB<th>light and material "
      "alone, dB<th>vertices<th>seconds<th>files<th>remarks</tr>\n";
  for (size_t page = pages; page-- > 0;) {  // the first last: it is there when all others are
    std::string text = top;
    for (size_t i = page * kRowsOnAPage; i < std::min(rows.size(), (page + 1) * kRowsOnAPage); ++i)
      text += table_row(rows[i], folder);
    write_file_atomic(page_file(out, page), text + "</table></html>\n");
  }
}

}  // namespace cei3d

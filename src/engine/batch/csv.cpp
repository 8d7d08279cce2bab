// SPDX-License-Identifier: Apache-2.0
#include "engine/batch/csv.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/name_distance.h"
#include "core/base/parse_json.h"

namespace cei3d {
namespace {

const std::vector<std::string> kTexts{"id", "capture", "for", "keep"}, kLists{"steps", "export"},
    kNumbers{"unit_scale", "frames", "stub_seconds"},
    kTextOptions{"preset", "light", "light_color", "poses", "exposures", "format"},
    kNumberOptions{"seconds", "iterations", "joint", "seed", "downscale", "test_every", "views"};

bool is_in(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

Json number_of(const std::string& field, const std::string& column, const std::string& what) {
  const Json j = parse_json(field);
  if (!j.is_number()) fail("{}: '{}' of column '{}' is no number.", what, field, column);
  return j;
}

Json words_of(const std::string& field) {
  Json out = Json::array();
  for (size_t begin = 0; begin < field.size();) {
    const size_t end = std::min(field.find(';', begin), field.size());
    out.push_back(field.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

void put(const std::string& column, const std::string& field, const std::string& what, Json& line) {
  if (field.empty()) return;
  if (is_in(kTexts, column))
    line[column] = field;
  else if (is_in(kLists, column))
    line[column] = words_of(field);
  else if (is_in(kNumbers, column))
    line[column] = number_of(field, column, what);
  else if (is_in(kTextOptions, column))
    line["options"][column] = field;
  else if (is_in(kNumberOptions, column))
    line["options"][column] = number_of(field, column, what);
  else
    line["tags"][column.substr(std::string("tag.").size())] = field;
}

// Spreadsheets save tables in the encoding of the system, too.
void check_encoding(const std::string& text, const std::string& what) {
  try {
    Json(text).dump();
  } catch (const Json::exception&) {
    fail("{} is not UTF-8; save it as a CSV in UTF-8.", what);
  }
}

void check_columns(const std::vector<std::string>& columns, const std::string& what) {
  std::vector<std::string> known;
  for (const auto* list : {&kTexts, &kLists, &kNumbers, &kTextOptions, &kNumberOptions})
    known.insert(known.end(), list->begin(), list->end());
  for (const std::string& c : columns)
    if (!is_in(known, c) && !c.starts_with("tag."))
      fail("{}: there is no column '{}'; the nearest is '{}'. Columns of your own begin with 'tag.'.", what,
           c, nearest_name(c, known));
}

}  // namespace

std::vector<std::vector<std::string>> csv_table(const std::string& text, const std::string& what) {
  std::vector<std::vector<std::string>> table;
  std::vector<std::string> fields(1);
  bool quoted = false;
  const auto end_line = [&] {
    if (fields.size() > 1 || !fields[0].empty()) table.push_back(fields);
    fields.assign(1, "");
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool doubled = quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"';
    if (doubled)
      fields.back() += text[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (quoted || (c != ',' && c != '\n' && c != '\r'))
      fields.back() += c;
    else if (c == ',')
      fields.emplace_back();
    else if (c == '\n')
      end_line();
  }
  if (quoted) fail("{}: a quote is not closed.", what);
  end_line();
  return table;
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string out;
  for (size_t i = 0; i < fields.size(); ++i) {
    const bool quoted = fields[i].find_first_of(",\"\r\n") != std::string::npos;
    out += i == 0 ? "" : ",";
    if (quoted) out += '"';
    for (const char c : fields[i]) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    if (quoted) out += '"';
  }
  return out + "\n";
}

std::vector<Json> lines_of_csv(const std::string& text, const std::string& what) {
  check_encoding(text, what);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  const auto table =
      csv_table(text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text, what);
  if (table.empty()) fail("{} is empty; its first line names the columns.", what);
  check_columns(table[0], what);
  std::vector<Json> out;
  for (size_t row = 1; row < table.size(); ++row) {
    const std::string where = fmt::format("{}, line {}", what, row + 1);
    if (table[row].size() != table[0].size())
      fail("{} has {} fields, but there are {} columns.", where, table[row].size(), table[0].size());
    Json line = Json::object();
    for (size_t i = 0; i < table[0].size(); ++i) put(table[0][i], table[row][i], where, line);
    out.push_back(line);
  }
  return out;
}

}  // namespace cei3d

// SPDX-License-Identifier: Apache-2.0
// Text files of numbers: lines, and words of a line.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace cei3d {

class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next() {
    if (rest_.empty()) return false;
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }
  // The next line that is neither empty nor a comment, which begins with #.
  bool next_data() {
    while (next()) {
      const size_t first = line_.find_first_not_of(" \t");
      if (first != std::string_view::npos && line_[first] != '#') return true;
    }
    return false;
  }
  std::string_view line() const { return line_; }
  int number() const { return number_; }  // of the line, from 1

 private:
  std::string_view rest_, line_;
  int number_ = 0;
};

// Words of a line, separated by blanks or by one of `separators`. where: for error messages.
class Words {
 public:
  Words(std::string_view line, std::string where, const char* separators = " \t")
      : rest_(line), where_(std::move(where)), separators_(separators) {}

  bool at_end() {
    const size_t first = rest_.find_first_not_of(separators_);
    rest_.remove_prefix(std::min(first, rest_.size()));
    return rest_.empty();
  }
  std::string_view word() {
    if (at_end()) fail("{} ends too early.", where_);
    const size_t end = std::min(rest_.find_first_of(separators_), rest_.size());
    const std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return out;
  }
  double number() {
    const std::string_view text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("{} should have a number where it has '{}'.", where_, text.substr(0, 40));
    return value;
  }
  // A whole number that is not negative.
  uint64_t whole() {
    const double value = number();
    if (!(value >= 0 && value <= 9e15 && value == double(uint64_t(value))))
      fail("{} should have a whole number where it has {:g}.", where_, value);
    return uint64_t(value);
  }
  std::string_view rest() {
    at_end();
    return rest_;
  }

 private:
  std::string_view rest_;
  std::string where_;
  const char* separators_;
};

}  // namespace cei3d

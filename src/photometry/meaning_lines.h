#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "base/intensity_table.h"
#include "photometry/file_text.h"

namespace catoptric::photometry {

/// The lines of a EULUMDAT file, each of which has its meaning. Whatever is refused is refused with the file,
/// the line last read and its meaning.
class MeaningLines {
 public:
  MeaningLines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {}

  std::string text(std::string_view meaning) {
    next(meaning);
    return std::string(line_);
  }

  template <typename Number = double>
  Number number(std::string_view meaning) {
    next(meaning);
    return parsed<Number>(meaning);
  }

  /// 0 for an empty line.
  double optional_number(std::string_view meaning) {
    next(meaning);
    return line_.empty() ? 0 : parsed<double>(meaning);
  }

  double size(std::string_view meaning) {
    const double value = optional_number(meaning);
    if (!(value >= 0)) refuse(fmt::format("it is {}", value), meaning, "it is not negative");
    return value;
  }

  int count(std::string_view meaning, int least, int greatest) {
    const double value = number(meaning);
    if (!(value >= least && value <= greatest) || value != std::floor(value))
      refuse(fmt::format("it is {}", value), meaning,
             fmt::format("it is a whole number from {} to {}", least, greatest));
    return static_cast<int>(value);
  }

  /// So many lines must be left, none empty.
  void require_room(std::size_t lines, std::string_view meaning) const {
    if (lines > rest_.size() / 2 + 1)
      refuse(fmt::format("{} values are announced, the rest of the file has room for {}", lines,
                         rest_.size() / 2 + 1),
             meaning, "the file holds all values that Mc, Ng and Isym announce",
             "check them, and whether the file was cut off");
  }

  std::vector<double> angles(int count, std::string_view meaning) {
    require_room(static_cast<std::size_t>(count), meaning);
    std::vector<double> result;
    for (int i = 0; i < count; ++i) {
      result.push_back(number(meaning));
      if (i > 0 && !(result.back() - result[result.size() - 2] >= least_angle_step_deg))
        refuse(fmt::format("{} follows {}", result.back(), result[result.size() - 2]), meaning,
               "angles ascend, none is there twice", "check Mc and Ng");
    }
    return result;
  }

  /// What is left that is not blank; the line of it is the last one read.
  std::string_view remainder() {
    line_ = {};
    while (!rest_.empty() && line_.empty()) next("");
    return line_;
  }

  [[noreturn]] void refuse(std::string what, std::string_view meaning, std::string why,
                           std::string hint = "") const {
    throw InputError({std::move(what), fmt::format("{}:{}, {}", name_, line_number_, meaning), std::move(why),
                      std::move(hint)});
  }

 private:
  void next(std::string_view meaning) {
    ++line_number_;
    if (rest_.empty())
      refuse("the file ends here", meaning, "a line is missing", "check whether the file was cut off");
    line_ = without_blanks(take_line(rest_));
  }

  template <typename Number>
  Number parsed(std::string_view meaning) const {
    std::string digits(line_.starts_with('+') ? line_.substr(1) : line_);
    if (digits.find('.') == std::string::npos && std::count(digits.begin(), digits.end(), ',') == 1)
      digits[digits.find(',')] = '.';
    Number value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
      refuse(fmt::format("\"{}\" is no finite number", cited(line_)), meaning, "one number stands in a line",
             "check that no line is missing before");
    return value;
  }

  std::string_view rest_, line_;
  std::string name_;
  std::size_t line_number_ = 0;
};

}  // namespace catoptric::photometry

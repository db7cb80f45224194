#include "photometry/number_stream.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "base/errors.h"
#include "base/intensity_table.h"
#include "photometry/file_text.h"

namespace catoptric::photometry {
namespace {

bool separates(char c) { return c == ' ' || c == ',' || c == '\t' || c == '\r' || c == '\n'; }

}  // namespace

void NumberStream::refuse(std::string what, std::string_view field, std::string why, std::string hint) const {
  throw InputError(
      {std::move(what), fmt::format("{}:{}, {}", name_, line_, field), std::move(why), std::move(hint)});
}

void NumberStream::skip_separators() {
  while (!rest_.empty() && separates(rest_.front())) {
    if (rest_.front() == '\n') ++line_;
    rest_.remove_prefix(1);
  }
}

bool NumberStream::at_end() {
  skip_separators();
  return rest_.empty();
}

std::string_view NumberStream::next_word() {
  skip_separators();
  std::size_t length = 0;
  while (length < rest_.size() && !separates(rest_[length])) ++length;
  const std::string_view word = rest_.substr(0, length);
  rest_.remove_prefix(length);
  return word;
}

double NumberStream::next(std::string_view field) {
  std::string_view word = next_word();
  if (word.empty())
    refuse("the file ends here", field, "a number is missing", "check whether the file was cut off");
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse(fmt::format("\"{}\" is no finite number", cited(word)), field,
           "numbers are separated by blanks or commas, decimals by a point");
  return value;
}

int NumberStream::next_count(std::string_view field, int least, int greatest) {
  const double value = next(field);
  if (!(value >= least && value <= greatest) || value != std::floor(value))
    refuse(fmt::format("it is {}", value), field,
           fmt::format("it is a whole number from {} to {}", least, greatest));
  return static_cast<int>(value);
}

void NumberStream::require_room(std::size_t count, std::string_view field) const {
  if (count > most_values)
    refuse(fmt::format("{} values are announced", count), field,
           fmt::format("at most {} are read", most_values), "check the counts of angles");
  const std::size_t room = rest_.size() / 2 + 1;  // a number takes a digit and a separator
  if (count > room)
    refuse(fmt::format("{} values are announced, the rest of the file has room for {}", count, room), field,
           "the file holds all values that its counts announce",
           "check the counts, and whether the file was cut off");
}

std::vector<double> NumberStream::next_angles(std::size_t count, std::string_view field) {
  require_room(count, field);
  std::vector<double> angles(count);
  for (std::size_t i = 0; i < count; ++i) {
    angles[i] = next(field);
    if (i > 0 && !(angles[i] - angles[i - 1] >= least_angle_step_deg))
      refuse(fmt::format("{} follows {}", angles[i], angles[i - 1]), field,
             "angles ascend, none is there twice", "check the counts of angles");
  }
  return angles;
}

}  // namespace catoptric::photometry

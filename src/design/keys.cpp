#include "design/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::design {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

bool fits(std::string_view pattern, std::string_view path) {
  while (true) {
    const auto pattern_dot = pattern.find('.'), path_dot = path.find('.');
    const auto part = pattern.substr(0, pattern_dot);
    if (part == "*" && pattern_dot != std::string_view::npos)
      for (auto dot = path_dot; dot != std::string_view::npos; dot = path.find('.', dot + 1))
        if (fits(pattern.substr(pattern_dot + 1), path.substr(dot + 1))) return true;
    if (part != "*" && part != path.substr(0, path_dot)) return false;
    if ((pattern_dot == std::string_view::npos) != (path_dot == std::string_view::npos)) return false;
    if (pattern_dot == std::string_view::npos) return true;
    pattern.remove_prefix(pattern_dot + 1);
    path.remove_prefix(path_dot + 1);
  }
}

std::size_t lengths_differ(std::string_view a, std::string_view b) {
  return a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
}

}  // namespace

const Key* find_key(std::span<const Key> keys, std::string_view path) {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& key) {
    return key.path == path || (key.path.find('*') != std::string_view::npos && fits(key.path, path));
  });
  return found == keys.end() ? nullptr : &*found;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Of the table of costs only three rows are ever looked at.
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  before_last = last = row;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string nearest_path(std::span<const Key> keys, std::string_view path) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, path.size() / 3) + 1;
  const auto last_name = [](std::string_view whole) { return whole.substr(whole.rfind('.') + 1); };
  for (const Key& key : keys) {
    // What is much longer or shorter is not near; a hostile name may have a million letters.
    const bool comparable = lengths_differ(key.path, path) < least;
    std::size_t distance = comparable ? edit_distance(key.path, path) : least;
    if (last_name(key.path) == last_name(path)) distance = std::min<std::size_t>(distance, 2);  // wrong table
    if (distance < least) {
      least = distance;
      best = std::string(key.path);
    }
  }
  return best;
}

std::string nearest_choice(const Key& key, std::string_view value) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, value.size() / 3) + 1;
  for (const std::string_view choice : key.choices) {
    if (lengths_differ(choice, value) >= least) continue;
    const std::size_t distance = edit_distance(choice, value);
    if (distance >= least) continue;
    least = distance;
    best = choice;
  }
  return std::string(best);
}

std::string reference(std::span<const Key> keys) {
  std::string text;
  for (const Key& key : keys) {
    text += fmt::format("{}\n    {}\n    {}", key.path, key.meaning, rule(key));
    if (!key.standard.empty()) text += fmt::format("; {} when left out", key.standard);
    text += "\n";
  }
  return text;
}

std::string rule(const Key& key) {
  std::string text;
  switch (key.type) {
    case KeyType::text:
      return "a text in quotes";
    case KeyType::choice:
      return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
    case KeyType::boolean:
      return "true or false";
    case KeyType::texts:
      return "a list of texts";
    case KeyType::integer:
      text = "a whole number";
      break;
    case KeyType::number:
      text = "a number";
      break;
    case KeyType::numbers:
      text = key.count ? fmt::format("a list of {} numbers", key.count) : "a list of numbers";
      break;
    case KeyType::points:
      text = "a list of pairs [a, b]";
      break;
  }
  if (key.least != -unbounded && std::abs(key.least) != farthest)
    text += fmt::format(" {} {}", key.least_excluded ? ">" : ">=", key.least);
  if (key.greatest != unbounded && key.greatest != farthest) text += fmt::format(" and <= {}", key.greatest);
  if (key.quantity == Quantity::length) text += ", in the scene's unit of length";
  if (key.quantity == Quantity::power_w) text += ", in W";
  if (key.quantity == Quantity::flux_lm) text += ", in lm";
  if (key.quantity == Quantity::irradiance) text += ", in W/m^2, or lx with source.flux";
  return text;
}

}  // namespace catoptric::design

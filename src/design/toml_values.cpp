#include "design/toml_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "base/whole_file.h"

namespace catoptric::design {
namespace {

/// toml++ limits how deep values nest, but not the parts of a dotted name, each of which is a table within
/// the last: some ten thousand overflow the stack when they are taken down.
constexpr int most_name_parts = 64;

/// Where the quoted text that begins at `at` ends; the end of `text` when it does not.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool long_text = text.substr(at, 3) == three;
  for (std::size_t i = at + (long_text ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"')
      ++i;
    else if (long_text ? text.substr(i, 3) == three : text[i] == quote)
      return i + (long_text ? 3 : 1);
    else if (!long_text && text[i] == '\n')
      return i;
  }
  return text.size();
}

/// Where in `text` a name has too many parts, or nothing.
std::optional<std::size_t> find_deep_name(std::string_view text) {
  int parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_quoted(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '.' && ++parts > most_name_parts) return i;
    if (std::string_view("\n,=[]{}").find(c) != std::string_view::npos) parts = 1;
    ++i;
  }
  return std::nullopt;
}

std::string type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number with a point";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

/// Collects what is needed to complain about one value.
struct Complaint {
  const Key& key;
  std::string_view path;
  const std::string& where;

  [[noreturn]] void wrong_type(const toml::node& node) const {
    throw InputError({fmt::format("{} is {}", path, type_name(node)), where,
                      fmt::format("it must be {}", rule(key)), fmt::format("{}", key.meaning)});
  }
  [[noreturn]] void out_of_range(const std::string& value) const {
    throw InputError({fmt::format("{} = {} is out of range", path, value), where,
                      fmt::format("it must be {}", rule(key)), std::string(key.meaning)});
  }
  [[noreturn]] void no_choice(const std::string& value) const {
    const std::string near = nearest_choice(key, value);
    throw InputError({fmt::format("{} = \"{}\" is no choice", path, value), where,
                      fmt::format("it must be {}", rule(key)),
                      near.empty() ? std::string(key.meaning) : fmt::format("did you mean \"{}\"?", near)});
  }
};

double checked_number(const Complaint& complaint, const toml::node& node) {
  if (!node.is_floating_point() && !node.is_integer()) complaint.wrong_type(node);
  // A whole number that no double holds takes the nearest, like any decimal.
  const double value =
      node.is_integer() ? static_cast<double>(**node.as_integer()) : **node.as_floating_point();
  const Key& key = complaint.key;
  if (!std::isfinite(value) || value < key.least || value > key.greatest ||
      (key.least_excluded && value == key.least))
    complaint.out_of_range(fmt::format("{}", value));
  return value;
}

std::int64_t checked_integer(const Complaint& complaint, const toml::node& node) {
  if (!node.is_integer()) complaint.wrong_type(node);
  checked_number(complaint, node);
  return *node.value<std::int64_t>();
}

std::string checked_text(const Complaint& complaint, const toml::node& node) {
  if (!node.is_string()) complaint.wrong_type(node);
  std::string text = *node.value<std::string>();
  if (text.find('\0') != std::string::npos)
    throw InputError({fmt::format("{} holds the character NUL", complaint.path), complaint.where,
                      "no text and no name of a file has one", std::string(complaint.key.meaning)});
  const auto& choices = complaint.key.choices;
  if (complaint.key.type == KeyType::choice &&
      std::find(choices.begin(), choices.end(), text) == choices.end())
    complaint.no_choice(shortened(text));
  return text;
}

Numbers checked_numbers(const Complaint& complaint, const toml::node& node, std::size_t count) {
  const toml::array* list = node.as_array();
  if (!list) complaint.wrong_type(node);
  if (count != 0 && list->size() != count)
    complaint.out_of_range(fmt::format("a list of {} values", list->size()));
  Numbers numbers;
  for (const toml::node& each : *list) numbers.push_back(checked_number(complaint, each));
  return numbers;
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  std::variant<std::string, ErrorParts> read = read_whole_file(file);
  if (ErrorParts* defect = std::get_if<ErrorParts>(&read)) throw InputError(std::move(*defect));
  return std::get<std::string>(std::move(read));
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + "\"";
}

std::string shortened(std::string_view text) {
  constexpr std::size_t most = 80;
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not within a character
  return fmt::format("{}... ({} characters)", text.substr(0, end), text.size());
}

toml::table parse_toml(std::string_view text, const std::string& name) {
  if (const auto place = find_deep_name(text))
    throw InputError(
        {"a name has too many parts",
         fmt::format("{}:{}", name,
                     1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*place), '\n')),
         fmt::format("at most {} parts, with dots between them, are read", most_name_parts),
         "catoptric --keys lists all names"});
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto& begin = error.source().begin;
    throw InputError({"this is not valid TOML", fmt::format("{}:{}:{}", name, begin.line, begin.column),
                      std::string(error.description()),
                      "texts stand in quotes, lists in [ ], tables under [name]"});
  }
}

Setting checked(const Key& key, std::string_view path, const toml::node& node, const std::string& where) {
  const Complaint complaint{key, path, where};
  switch (key.type) {
    case KeyType::text:
    case KeyType::choice:
      return {checked_text(complaint, node), where};
    case KeyType::integer:
      return {checked_integer(complaint, node), where};
    case KeyType::number:
      return {checked_number(complaint, node), where};
    case KeyType::boolean:
      if (!node.is_boolean()) complaint.wrong_type(node);
      return {*node.value<bool>(), where};
    case KeyType::numbers:
      return {checked_numbers(complaint, node, key.count), where};
    case KeyType::points: {
      const toml::array* list = node.as_array();
      if (!list) complaint.wrong_type(node);
      Points points;
      for (const toml::node& each : *list) points.push_back(checked_numbers(complaint, each, 2));
      return {points, where};
    }
    case KeyType::texts: {
      const toml::array* list = node.as_array();
      if (!list) complaint.wrong_type(node);
      Texts texts;
      for (const toml::node& each : *list) texts.push_back(checked_text(complaint, each));
      return {texts, where};
    }
  }
  complaint.wrong_type(node);
}

}  // namespace catoptric::design

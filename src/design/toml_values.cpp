#include "design/toml_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace catoptric::design {
namespace {

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
  const auto value = node.value<double>();
  if (!value || !(node.is_floating_point() || node.is_integer())) complaint.wrong_type(node);
  const Key& key = complaint.key;
  if (!std::isfinite(*value) || *value < key.least || *value > key.greatest ||
      (key.least_excluded && *value == key.least))
    complaint.out_of_range(fmt::format("{}", *value));
  return *value;
}

std::int64_t checked_integer(const Complaint& complaint, const toml::node& node) {
  if (!node.is_integer()) complaint.wrong_type(node);
  checked_number(complaint, node);
  return *node.value<std::int64_t>();
}

std::string checked_text(const Complaint& complaint, const toml::node& node) {
  if (!node.is_string()) complaint.wrong_type(node);
  std::string text = *node.value<std::string>();
  const auto& choices = complaint.key.choices;
  if (complaint.key.type == KeyType::choice &&
      std::find(choices.begin(), choices.end(), text) == choices.end())
    complaint.no_choice(text);
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
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError({"this is a folder", file.string(), "a file is needed", "name a file in it"});
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError({"cannot read the file", file.string(), "", "check the name and its permissions"});
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

toml::table parse_toml(std::string_view text, const std::string& name) {
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

#include "fuzz/support/iges_mutator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace catoptric::fuzz {
namespace {

constexpr std::array<const char*, 40> types{
    "100", "102", "104", "106", "108", "110", "112", "114", "116", "118", "120", "122", "123", "124",
    "126", "128", "130", "140", "141", "142", "143", "144", "150", "154", "158", "162", "164", "180",
    "184", "186", "190", "192", "212", "308", "402", "406", "408", "502", "504", "510"};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else if (c == ';')
      break;
    else
      parts.back() += c;
  return parts;
}

std::string section(const std::string& line) { return line.size() > 72 ? line.substr(72, 1) : ""; }

}  // namespace

IgesMutator::IgesMutator(const std::string& text) {
  std::vector<std::string> directory, parameters;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (section(line) == "S") start_ += line + "\n";
    if (section(line) == "G") global_ += line.substr(0, 72);
    if (section(line) == "D") directory.push_back(line);
    if (section(line) == "P") parameters.push_back(line);
  }
  for (std::size_t i = 0; i + 1 < directory.size(); i += 2) {
    Entity entity;
    for (std::size_t field = 0; field < 20; ++field)
      entity.fields[field] = directory[i + field / 10].substr(8 * (field % 10), 8);
    const std::size_t first = std::strtoul(entity.fields[1].c_str(), nullptr, 10);
    const std::size_t count = std::strtoul(entity.fields[13].c_str(), nullptr, 10);
    std::string data;
    for (std::size_t line = first; line < first + count && line <= parameters.size(); ++line)
      data += parameters[line - 1].substr(0, 64);
    while (!data.empty() && data.back() == ' ') data.pop_back();
    entity.parameters = split(data);
    entities_.push_back(std::move(entity));
  }
}

void IgesMutator::mutate(Entity& entity, std::size_t entities, Chance& chance) {
  std::vector<std::string>& values = entity.parameters;
  std::string& value = values[chance.below(values.size())];
  const auto pointer = [&] { return std::to_string(2 * chance.below(entities) + 1); };
  switch (chance.below(10)) {
    case 0:
    case 1:
      value = chance.of(hostile_numbers());
      break;
    case 2:
      value = pointer();
      break;
    case 3:
      value = values[chance.below(values.size())];
      break;
    case 4:  // counts stand first
      values[std::min<std::size_t>(values.size() - 1, 1 + chance.below(4))] = chance.of(hostile_numbers());
      break;
    case 5:
      values.erase(values.begin() + static_cast<long>(chance.below(values.size())));
      if (values.empty()) values.emplace_back("0");
      break;
    case 6: {
      const std::size_t times = chance.one_in(10) ? 1 + chance.below(1000) : 1;
      const std::string copy = value;
      values.insert(values.begin() + static_cast<long>(chance.below(values.size())), times, copy);
      break;
    }
    case 7:
      entity.fields[0] = entity.fields[10] = values[0] = types[chance.below(types.size())];
      break;
    case 8:
      entity.fields[chance.below(20)] = chance.one_in(2) ? pointer() : chance.of(hostile_numbers());
      break;
    default:
      entity.fields[6] = pointer();  // its matrix
      break;
  }
}

std::string IgesMutator::laid_out(const std::vector<Entity>& entities, const std::string& global,
                                  Chance& chance) const {
  std::string file = start_, directory, data;
  std::size_t global_lines = 0, line = 1;
  for (std::size_t at = 0; at < global.size(); at += 72)
    file += fmt::format("{:<72}G{:7}\n", global.substr(at, 72), ++global_lines);
  const bool honest = !chance.one_in(10);  // or directory fields keep their mutated pointers
  for (std::size_t i = 0; i < entities.size(); ++i) {
    std::array<std::string, 20> fields = entities[i].fields;
    const std::size_t first = line;
    std::string row;
    const auto flush = [&] {
      data += fmt::format("{:<64.64}{:8}P{:7}\n", row, 2 * i + 1, line++);
      row.clear();
    };
    for (std::size_t k = 0; k < entities[i].parameters.size(); ++k) {
      const bool last = k + 1 == entities[i].parameters.size();
      const std::string piece = entities[i].parameters[k] + (last ? ";" : ",");
      if (row.size() + piece.size() > 64) flush();
      row += piece;
    }
    flush();
    if (honest) {
      fields[1] = std::to_string(first);
      fields[13] = std::to_string(line - first);
    }
    for (std::size_t half = 0; half < 2; ++half) {
      for (std::size_t field = 0; field < 9; ++field)
        directory += fmt::format("{:>8.8}", fields[10 * half + field]);
      directory += fmt::format("D{:7}\n", 2 * i + half + 1);
    }
  }
  const std::string counts =
      fmt::format("S{:7}G{:7}D{:7}P{:7}", 1, global_lines, 2 * entities.size(), line - 1);
  return file + directory + data + fmt::format("{:<72}T{:7}\n", counts, 1);
}

std::string IgesMutator::mutated(Chance& chance) const {
  std::vector<Entity> entities = entities_;
  std::string global = global_;
  for (std::size_t rounds = 1 + chance.below(4); rounds > 0; --rounds) switch (chance.below(12)) {
      case 0:
        mutate_bytes(global, chance);
        break;
      case 1:
        if (entities.size() > 1)
          entities.erase(entities.begin() + static_cast<long>(chance.below(entities.size())));
        break;
      case 2:
        entities.push_back(entities[chance.below(entities.size())]);
        break;
      case 3:
        std::swap(entities[chance.below(entities.size())], entities[chance.below(entities.size())]);
        break;
      default:
        mutate(entities[chance.below(entities.size())], entities.size(), chance);
        break;
    }
  std::string text = laid_out(entities, global, chance);
  if (chance.one_in(5))
    for (std::size_t rounds = 1 + chance.below(3); rounds > 0; --rounds) mutate_bytes(text, chance);
  return text;
}

}  // namespace catoptric::fuzz

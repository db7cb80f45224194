#pragma once

#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::test {

/// Reads ISO 10303-21 text by its own rules, without a CAD kernel, as far as a surface of revolution needs
/// it: entity instances by number, simple and complex, and what stands between an entity's brackets.
class StepText {
 public:
  explicit StepText(const std::string& file) {
    const std::size_t data = file.find("DATA;");
    if (data == std::string::npos) throw std::runtime_error("no DATA section");
    std::string statement;
    bool in_string = false;
    for (std::size_t i = data + 5; i < file.size(); ++i) {
      const char c = file[i];
      if (c == '\'') in_string = !in_string;
      if (c == ';' && !in_string) {
        add(statement);
        statement.clear();
      } else if (in_string || (c != ' ' && c != '\n' && c != '\r')) {
        statement += c;
      }
    }
  }

  /// Numbers of all instances that are, or are also, of that type.
  std::vector<int> all(const std::string& type) const {
    std::vector<int> numbers;
    for (const auto& [number, text] : instances_)
      if (text.find(type + "(") == 0 || text.find("(" + type + "(") != std::string::npos ||
          text.find(")" + type + "(") != std::string::npos)
        numbers.push_back(number);
    return numbers;
  }

  /// Arguments of one type within an instance, split at commas of the first level.
  std::vector<std::string> arguments(int number, const std::string& type) const {
    const std::string& text = instances_.at(number);
    for (std::size_t at = text.find(type + "("); at != std::string::npos; at = text.find(type + "(", at + 1))
      if (at == 0 || text[at - 1] == '(' || text[at - 1] == ')')
        return split(bracket(text, at + type.size()));
    throw std::runtime_error("instance has no " + type);
  }

  /// The elements of a bracketed list.
  static std::vector<std::string> list(const std::string& text) { return split(bracket(text, 0)); }

  static int reference(const std::string& text) {
    if (text.empty() || text[0] != '#') throw std::runtime_error("no reference: " + text);
    return std::atoi(text.c_str() + 1);
  }

  /// Coordinates of a CARTESIAN_POINT or DIRECTION.
  std::vector<double> triple(int number) const {
    const std::string& text = instances_.at(number);
    std::vector<double> values;
    for (const std::string& each : list(split(bracket(text, text.find('(')))[1]))
      values.push_back(std::strtod(each.c_str(), nullptr));
    return values;
  }

  /// References to instances that are not in the file.
  std::set<int> dangling() const {
    std::set<int> missing;
    for (const auto& [number, text] : instances_)
      for (std::size_t at = text.find('#'); at != std::string::npos; at = text.find('#', at + 1))
        if (const int to = std::atoi(text.c_str() + at + 1); instances_.count(to) == 0) missing.insert(to);
    return missing;
  }

 private:
  void add(const std::string& statement) {
    if (statement.empty() || statement[0] != '#') return;
    const std::size_t equals = statement.find('=');
    instances_[std::atoi(statement.c_str() + 1)] = statement.substr(equals + 1);
  }

  /// What stands between the bracket at `open` and its partner.
  static std::string bracket(const std::string& text, std::size_t open) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = open; i < text.size(); ++i) {
      if (text[i] == '\'') in_string = !in_string;
      if (in_string) continue;
      if (text[i] == '(') ++depth;
      if (text[i] == ')' && --depth == 0) return text.substr(open + 1, i - open - 1);
    }
    throw std::runtime_error("brackets do not match: " + text);
  }

  static std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    bool in_string = false;
    for (const char c : text) {
      if (c == '\'') in_string = !in_string;
      if (!in_string && c == '(') ++depth;
      if (!in_string && c == ')') --depth;
      if (c == ',' && depth == 0 && !in_string)
        parts.emplace_back();
      else
        parts.back() += c;
    }
    return parts;
  }

  std::map<int, std::string> instances_;
};

/// A generatrix as the file's text has it, in the file's unit.
struct StepGeneratrix {
  int degree = 0;
  std::vector<std::vector<double>> poles;
  std::vector<double> weights;  ///< empty for a polynomial curve
  std::vector<double> flat_knots;
  std::vector<double> axis_point, axis_direction;
};

/// All surfaces of revolution on B-splines in a STEP file.
inline std::vector<StepGeneratrix> generatrices(const StepText& file) {
  std::vector<StepGeneratrix> found;
  for (const int surface : file.all("SURFACE_OF_REVOLUTION")) {
    const auto parts = file.arguments(surface, "SURFACE_OF_REVOLUTION");
    const int curve = StepText::reference(parts[1]), axis = StepText::reference(parts[2]);
    StepGeneratrix result;
    const auto placement = file.arguments(axis, "AXIS1_PLACEMENT");
    result.axis_point = file.triple(StepText::reference(placement[1]));
    result.axis_direction = file.triple(StepText::reference(placement[2]));
    auto knots = file.arguments(curve, "B_SPLINE_CURVE_WITH_KNOTS");
    auto basic = knots;
    const auto rational = file.all("RATIONAL_B_SPLINE_CURVE");
    const bool is_complex = knots.size() == 3;
    if (is_complex) {  // ( BOUNDED_CURVE() B_SPLINE_CURVE(degree, poles, ...) ... ), without the name
      basic = file.arguments(curve, "B_SPLINE_CURVE");
      for (const std::string& each : StepText::list(file.arguments(curve, "RATIONAL_B_SPLINE_CURVE")[0]))
        result.weights.push_back(std::strtod(each.c_str(), nullptr));
    } else {
      basic.erase(basic.begin());
      knots.erase(knots.begin(), knots.begin() + 6);
    }
    result.degree = std::atoi(basic[0].c_str());
    for (const std::string& pole : StepText::list(basic[1]))
      result.poles.push_back(file.triple(StepText::reference(pole)));
    const auto multiplicities = StepText::list(knots[0]), values = StepText::list(knots[1]);
    for (std::size_t i = 0; i < values.size(); ++i)
      result.flat_knots.insert(result.flat_knots.end(),
                               static_cast<std::size_t>(std::atoi(multiplicities[i].c_str())),
                               std::strtod(values[i].c_str(), nullptr));
    found.push_back(std::move(result));
  }
  return found;
}

}  // namespace catoptric::test

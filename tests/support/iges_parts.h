#pragma once

#include <cstdlib>
#include <string>
#include <vector>

namespace catoptric::test {

/// Parameters of all entities of one type in an IGES file, read by columns, without a CAD kernel.
inline std::vector<std::vector<std::string>> iges_entities(const std::string& file, int type) {
  std::vector<std::vector<std::string>> found;
  std::string current;
  for (std::size_t start = 0; start < file.size();) {
    const std::size_t end = file.find('\n', start);
    const std::string line = file.substr(start, end - start);
    start = end == std::string::npos ? file.size() : end + 1;
    if (line.size() < 73 || line[72] != 'P') continue;
    std::string data = line.substr(0, 64);
    data.erase(data.find_last_not_of(' ') + 1);
    current += data;
    if (current.empty() || current.back() != ';') continue;
    current.pop_back();
    std::vector<std::string> fields(1);
    for (const char c : current)
      if (c == ',')
        fields.emplace_back();
      else
        fields.back() += c;
    if (std::atoi(fields[0].c_str()) == type) found.push_back(fields);
    current.clear();
  }
  return found;
}

/// A 126 in the file's unit.
struct IgesSpline {
  int degree;
  std::vector<double> knots, weights;
  std::vector<std::vector<double>> points;
};

inline std::vector<IgesSpline> iges_splines(const std::string& file) {
  std::vector<IgesSpline> splines;
  for (const auto& fields : iges_entities(file, 126)) {
    IgesSpline spline{std::atoi(fields[2].c_str()), {}, {}, {}};
    const auto poles = static_cast<std::size_t>(std::atoi(fields[1].c_str())) + 1;
    const std::size_t knots = poles + static_cast<std::size_t>(spline.degree) + 1;
    std::size_t at = 7;
    const auto next = [&] { return std::strtod(fields.at(at++).c_str(), nullptr); };
    for (std::size_t i = 0; i < knots; ++i) spline.knots.push_back(next());
    for (std::size_t i = 0; i < poles; ++i) spline.weights.push_back(next());
    for (std::size_t i = 0; i < poles; ++i) {
      const double x = next(), y = next(), z = next();
      spline.points.push_back({x, y, z});
    }
    splines.push_back(spline);
  }
  return splines;
}

}  // namespace catoptric::test

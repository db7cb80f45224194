#pragma once

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::test {

/// Writes IGES 5.3 files as text, by the standard's rules alone: no CAD kernel has a hand in them, so that
/// our reader is not tested on its own output. Entities are added one by one; text() lays them out in 80
/// columns.
/// @from  IGES 5.3 (ANS US PRO/IPO-100-1996), chapters 2 and 4
class IgesText {
 public:
  using Point = std::array<double, 3>;
  /// Rows of a rotation, each followed by a component of the translation (entity 124).
  using Matrix = std::array<std::array<double, 4>, 3>;

  /// Where an entity belongs: on its own, or part of another one.
  enum class Role { independent, dependent };

  struct Entity {
    int type, form;
    std::string parameters;  ///< without type and end mark
    Role role = Role::independent;
    int matrix = 0;  ///< directory number of a 124, 0 for none
  };

  /// @in unit_flag, unit_name  1 "INCH", 2 "MM", 6 "M", 10 "CM"
  explicit IgesText(int unit_flag = 2, std::string unit_name = "MM")
      : unit_flag_(unit_flag), unit_name_(std::move(unit_name)) {}

  /// Adds an entity; its directory number, by which others point to it.
  int add(Entity entity) {
    entities_.push_back(std::move(entity));
    return static_cast<int>(2 * entities_.size() - 1);
  }

  /// 126: rational B-spline; flat knots. Equal weights make it polynomial.
  int spline(int degree, const std::vector<double>& knots, const std::vector<double>& weights,
             const std::vector<Point>& points, Role role = Role::independent) {
    bool polynomial = true;
    for (double weight : weights) polynomial = polynomial && weight == weights.front();
    std::string text = fmt::format("{},{},0,0,{},0", points.size() - 1, degree, polynomial ? 1 : 0);
    for (double knot : knots) text += "," + real(knot);
    for (double weight : weights) text += "," + real(weight);
    for (const Point& point : points) text += "," + coordinates(point);
    const auto p = static_cast<std::size_t>(degree);
    text += "," + real(knots[p]) + "," + real(knots[knots.size() - 1 - p]) + ",0.,0.,0.";
    return add({126, 0, text, role});
  }

  /// 110: line from a to b.
  int line(const Point& a, const Point& b, Role role = Role::independent) {
    return add({110, 0, coordinates(a) + "," + coordinates(b), role});
  }

  /// 106 form 12: polyline.
  int polyline(const std::vector<Point>& points, Role role = Role::independent) {
    std::string text = fmt::format("2,{}", points.size());
    for (const Point& point : points) text += "," + coordinates(point);
    return add({106, 12, text, role});
  }

  /// 100: arc in the plane z = zt of its own space, counterclockwise from (x1, y1) to (x2, y2).
  int arc(double zt, std::array<double, 2> centre, std::array<double, 2> from, std::array<double, 2> to,
          int matrix = 0, Role role = Role::independent) {
    return add({100, 0,
                fmt::format("{},{},{},{},{},{},{}", real(zt), real(centre[0]), real(centre[1]), real(from[0]),
                            real(from[1]), real(to[0]), real(to[1])),
                role, matrix});
  }

  /// 104: conic A x^2 + B x y + C y^2 + D x + E y + F = 0 between two points; form 1 ellipse, 2 hyperbola,
  /// 3 parabola.
  int conic(int form, const std::array<double, 6>& coefficients, std::array<double, 2> from,
            std::array<double, 2> to, int matrix = 0, Role role = Role::independent) {
    std::string text;
    for (double value : coefficients) text += real(value) + ",";
    text += fmt::format("0.,{},{},{},{}", real(from[0]), real(from[1]), real(to[0]), real(to[1]));
    return add({104, form, text, role, matrix});
  }

  /// 102: composite of entities in order.
  int composite(const std::vector<int>& parts) {
    std::string text = fmt::format("{}", parts.size());
    for (int part : parts) text += fmt::format(",{}", part);
    return add({102, 0, text});
  }

  /// 124: rotation and translation.
  int matrix(const Matrix& rows) {
    std::string text;
    for (const auto& row : rows)
      for (double value : row) text += (text.empty() ? "" : ",") + real(value);
    return add({124, 0, text, Role::dependent});
  }

  /// The file.
  std::string text() const {
    const std::vector<std::string> global = wrap(global_section(), 72);
    std::string directory, parameters;
    int line_number = 1;
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      const Entity& entity = entities_[i];
      const int number = static_cast<int>(2 * i + 1);
      const std::vector<std::string> data = wrap(fmt::format("{},{};", entity.type, entity.parameters), 64);
      directory += fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}00{:02}0000D{:7}\n", entity.type, line_number,
                               0, 1, 0, 0, entity.matrix, 0, entity.role == Role::dependent ? 1 : 0, number);
      directory += fmt::format("{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}D{:7}\n", entity.type, 0, 0, data.size(),
                               entity.form, "", "", "", 0, number + 1);
      for (const std::string& piece : data)
        parameters += fmt::format("{:<64}{:8}P{:7}\n", piece, number, line_number++);
    }
    std::string file =
        fmt::format("{:<72}S{:7}\n", "Written as text by the test support code iges_text.h", 1);
    for (std::size_t i = 0; i < global.size(); ++i) file += fmt::format("{:<72}G{:7}\n", global[i], i + 1);
    file += directory + parameters;
    const std::string counts =
        fmt::format("S{:7}G{:7}D{:7}P{:7}", 1, global.size(), 2 * entities_.size(), line_number - 1);
    return file + fmt::format("{:<72}T{:7}\n", counts, 1);
  }

  /// A real as IGES wants it: with a point, and every bit of the double.
  static std::string real(double value) {
    std::string text = fmt::format("{}", value);  // shortest text that reads back as the same double
    const std::size_t exponent = text.find('e');
    std::string mantissa = text.substr(0, exponent);
    if (mantissa.find('.') == std::string::npos) mantissa += ".";
    return exponent == std::string::npos ? mantissa : mantissa + "E" + text.substr(exponent + 1);
  }

 private:
  static std::string coordinates(const Point& point) {
    return real(point[0]) + "," + real(point[1]) + "," + real(point[2]);
  }

  static std::string hollerith(const std::string& text) { return fmt::format("{}H{}", text.size(), text); }

  std::string global_section() const {
    return fmt::format(",,{},{},{},{},32,38,6,308,15,{},1.,{},{},1,0.01,{},1E-9,1000.,{},{},11,0,{};",
                       hollerith("profile"), hollerith("profile.igs"), hollerith("catoptric tests"),
                       hollerith("1"), hollerith("profile"), unit_flag_, hollerith(unit_name_),
                       hollerith("19700101.000000"), hollerith("nobody"), hollerith("none"),
                       hollerith("19700101.000000"));
  }

  /// Breaks at commas only, so that no number is torn.
  static std::vector<std::string> wrap(const std::string& text, std::size_t width) {
    std::vector<std::string> lines{""};
    std::size_t start = 0;
    while (start < text.size()) {
      const std::size_t comma = text.find(',', start);
      const std::size_t end = comma == std::string::npos ? text.size() : comma + 1;
      if (lines.back().size() + (end - start) > width) lines.emplace_back();
      lines.back() += text.substr(start, end - start);
      start = end;
    }
    return lines;
  }

  int unit_flag_;
  std::string unit_name_;
  std::vector<Entity> entities_;
};

}  // namespace catoptric::test

#include "report/view_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;

/// Not by stod, which throws at numbers too small to be normal.
double rounded(double value) { return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr); }

template <typename Vector>
Json place(const Vector& point) {
  Json list = Json::array();
  for (const double value : point) list.push_back(rounded(value));
  return list;
}

template <typename Point>
Json places(const std::vector<Point>& points) {
  Json list = Json::array();
  for (const Point& point : points) list.push_back(place(point));
  return list;
}

Json source_json(const ViewedSource& source) {
  return {{"kind", source.kind},
          {"position", place(source.position)},
          {"axis", place(source.axis)},
          {"along", place(source.along)},
          {"radius", rounded(source.radius)},
          {"length", rounded(source.length)},
          {"width", rounded(source.width)},
          {"height", rounded(source.height)}};
}

Json field_json(const ViewedField& field) {
  Json outlines = Json::array();
  for (const Polyline& outline : field.outlines) outlines.push_back(places(outline));
  return {{"outlines", outlines}, {"center", place(field.center)}, {"flat", field.flat}};
}

/// How far along its way a point that moves from a to b leaves the ball, as a share; nothing within [0, 1]
/// gives 1.
double share_inside(const Vector3& a, const Vector3& b, const Vector3& center, double radius) {
  const Vector3 way = b - a, from = a - center;
  const double square = way.squaredNorm(), half = from.dot(way);
  if (!(square > 0)) return 1;
  const double root = half * half - square * (from.squaredNorm() - radius * radius);
  return root > 0 ? std::clamp((std::sqrt(root) - half) / square, 0.0, 1.0) : 0;
}

}  // namespace

std::string view_json(const View3d& view) {
  Json sources = Json::array(), fields = Json::array(), rays = Json::array();
  for (const ViewedSource& source : view.sources) sources.push_back(source_json(source));
  for (const ViewedField& field : view.fields) fields.push_back(field_json(field));
  for (const Polyline& ray : view.rays) rays.push_back(places(ray));
  Json objects = Json::array();
  for (const Polyline& line : view.objects) objects.push_back(places(line));
  const Json json = {{"mirror", places(view.generatrix)},
                     {"sources", sources},
                     {"fields", fields},
                     {"objects", objects},
                     {"rays", rays},
                     {"center", place(view.center)},
                     {"radius", rounded(view.radius)},
                     {"view_up", view.from_above ? 0.45 : -0.45}};
  return inside_script(json.dump());
}

Polyline within(const Polyline& path, const Vector3& center, double radius) {
  Polyline kept(path);
  while (kept.size() >= 2 && (kept.back() - center).norm() > radius) {
    const Vector3 before = kept[kept.size() - 2];
    const double share = share_inside(before, kept.back(), center, radius);
    if (share > 0) {
      kept.back() = before + share * (kept.back() - before);
      break;
    }
    kept.pop_back();
  }
  return kept;
}

std::string inside_script(std::string_view text) {
  constexpr std::array<std::string_view, 3> not_allowed{"<!--", "<script", "</script"};
  const auto stands_at = [&](std::size_t place, std::string_view word) {
    const std::string_view here = text.substr(place, word.size());
    return std::equal(here.begin(), here.end(), word.begin(), word.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  };
  std::string safe;
  safe.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool found =
        text[i] == '<' && std::any_of(not_allowed.begin(), not_allowed.end(),
                                      [&](std::string_view word) { return stands_at(i, word); });
    // in strings and patterns, the only places where these stand, this is the same character
    found ? safe += "\\u003c" : safe += text[i];
  }
  return safe;
}

}  // namespace catoptric::report

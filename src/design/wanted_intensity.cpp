#include "design/wanted_intensity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "base/units.h"
#include "design/csv_table.h"
#include "design/source_settings.h"
#include "photometry/intensity_file.h"

namespace catoptric::design {
namespace {

/// Plane angles beyond it lie too far out on the far plane.
constexpr double greatest_angle_deg = 85;

bool is_photometric(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".ies" || ending == ".ldt";
}

WantedIntensity from_csv(const Settings& settings, const std::string& file) {
  const CsvTable table = read_csv_table(file);
  const auto &angles = column(table, "angle", file), &wanted = column(table, "intensity", file);
  if (angles.empty() || !(angles.back() > 0))
    throw settings.error("target.intensity_file", "holds no angle above 0", "", "rows of angle, intensity");
  check_range(table, wanted, 0, greatest_irradiance_w_per_m2, "intensity", file);
  WantedIntensity result;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const std::string where = fmt::format("{}:{}", file, table.lines[i]);
    if (angles[i] < 0 || angles[i] > greatest_angle_deg || (i > 0 && !(angles[i] > angles[i - 1])))
      throw InputError({fmt::format("angle {} is out of order", angles[i]), where,
                        fmt::format("angles rise from 0 to {} degrees at most", greatest_angle_deg), ""});
    result.angles_rad.push_back(angles[i] * pi / 180);
    result.w_per_sr.push_back(wanted[i]);
  }
  return result;
}

/// Widths in C that the planes stand for, as shares of a full turn: of a table linear in between these give
/// the exact mean.
std::vector<double> shares_of_planes(const IntensityTable& table) {
  const std::vector<double>& c = table.c_deg();
  std::vector<double> shares(c.size(), 1.0);
  if (c.size() == 1) return shares;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double before = i == 0 ? c.back() - 360 : c[i - 1],
                 after = i + 1 == c.size() ? c[0] + 360 : c[i + 1];
    shares[i] = (after - before) / 720;
  }
  return shares;
}

void require_quantity(const Settings& settings, const IntensityTable& table, const std::string& file) {
  const LightQuantity scene = light_quantity(settings);
  if (table.quantity() == scene || settings.text("target.intensity_scale") == "free") return;
  throw settings.error(
      "target.intensity_file",
      fmt::format("{} holds {} in a scene of {}", file, intensity_unit(table.quantity()), flux_unit(scene)),
      "none is turned into the other without a spectrum",
      "source.flux instead of source.power, or target.intensity_scale = \"free\"");
}

void add_notes(const IntensityTable& table, std::vector<std::string>& notes) {
  if (const double off = c_asymmetry_rel(table, 0, greatest_angle_deg); off > 1e-9)  // roundings of the mean
    notes.push_back(fmt::format(
        "the intensity file is not alike in all C planes: its mean over C is wanted, and no light that is "
        "alike "
        "all round comes nearer to the file than a relative root mean square error of {:.3g} within {:g} "
        "degrees",
        off, greatest_angle_deg));
  const double all = table.flux(), beyond = table.zonal_flux(greatest_angle_deg, 180);
  if (all > 0 && beyond > 0)
    notes.push_back(fmt::format(
        "{:.3g} % of the intensity file's light leaves at more than {:g} degrees, where nothing is compared",
        100 * beyond / all, greatest_angle_deg));
}

WantedIntensity from_photometric(const Settings& settings, const std::string& file,
                                 std::vector<std::string>& notes) {
  const photometry::MeasuredIntensity read = photometry::read_intensity(file);
  const IntensityTable& table = read.table;
  require_quantity(settings, table, file);
  if (table.gamma_deg().front() > greatest_angle_deg)
    throw settings.error(
        "target.intensity_file", fmt::format("{} begins at {:g} degrees", file, table.gamma_deg().front()),
        fmt::format("its axis is the direction in which light leaves for the near field, and "
                    "angles up to {:g} degrees are compared",
                    greatest_angle_deg),
        "a file of light about gamma = 0");
  const std::vector<double> means = means_over_c(table);
  const double level = settings.number("target.intensity_level").value_or(1.0);
  WantedIntensity result;
  const auto add = [&](double angle_deg, double intensity) {
    const double wanted = level * intensity;
    if (!(wanted <= greatest_irradiance_w_per_m2))
      throw settings.error("target.intensity_file", fmt::format("intensity {} is out of range", wanted),
                           fmt::format("it lies between 0 and {}", greatest_irradiance_w_per_m2), "");
    result.angles_rad.push_back(angle_deg * pi / 180);
    result.w_per_sr.push_back(wanted);
  };
  const std::vector<double>& gamma = table.gamma_deg();
  for (std::size_t i = 0; i < gamma.size(); ++i) {
    if (gamma[i] <= greatest_angle_deg) {
      add(gamma[i], means[i]);
    } else {
      const double share = (greatest_angle_deg - gamma[i - 1]) / (gamma[i] - gamma[i - 1]);
      if (share > 0) add(greatest_angle_deg, (1 - share) * means[i - 1] + share * means[i]);
      break;
    }
  }
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  add_notes(table, notes);
  return result;
}

}  // namespace

WantedIntensity read_wanted_intensity(const Settings& settings, std::vector<std::string>& notes) {
  const std::string file = *settings.text("target.intensity_file");
  if (is_photometric(file)) return from_photometric(settings, file, notes);
  WantedIntensity result = from_csv(settings, file);
  const double level = settings.number("target.intensity_level").value_or(1.0);
  for (double& each : result.w_per_sr) each *= level;
  return result;
}

std::vector<double> means_over_c(const IntensityTable& table) {
  const std::vector<double> shares = shares_of_planes(table);
  std::vector<double> means(table.gamma_deg().size(), 0.0);
  for (std::size_t plane = 0; plane < shares.size(); ++plane)
    for (std::size_t i = 0; i < means.size(); ++i) means[i] += shares[plane] * table.value(plane, i);
  return means;
}

double c_asymmetry_rel(const IntensityTable& table, double from_deg, double to_deg) {
  const std::vector<double>&gamma = table.gamma_deg(), &c = table.c_deg();
  if (c.size() == 1) return 0;
  const double greatest = table.maximum();
  if (!(greatest > 0)) return 0;
  const std::vector<double> means = means_over_c(table);
  // At one gamma the table is linear from plane to plane, so that squares have a closed mean.
  const auto at = [&](std::size_t i, double share) {
    const auto value = [&](std::size_t plane) {
      return ((1 - share) * table.value(plane, i) + share * table.value(plane, i + 1)) / greatest;
    };
    const double mean = ((1 - share) * means[i] + share * means[i + 1]) / greatest;
    std::array<double, 2> squares{0, 0};  // of the table, of what differs from the mean
    for (std::size_t plane = 0; plane < c.size(); ++plane) {
      const std::size_t next = (plane + 1) % c.size();
      const double width = (next == 0 ? c[0] + 360 : c[next]) - c[plane], a = value(plane), b = value(next);
      const auto mean_square = [](double p, double q) { return (p * p + p * q + q * q) / 3; };
      squares[0] += width / 360 * mean_square(a, b);
      squares[1] += width / 360 * mean_square(a - mean, b - mean);
    }
    return squares;
  };
  double all = 0, off = 0;
  for (std::size_t i = 0; i + 1 < gamma.size(); ++i) {
    const double low = std::max(gamma[i], from_deg), high = std::min(gamma[i + 1], to_deg);
    if (!(high > low)) continue;
    for (const int part : {0, 1})
      (part == 0 ? all : off) += boost::math::quadrature::gauss<double, 7>::integrate(
          [&](double angle) {
            return at(i, (angle - gamma[i]) / (gamma[i + 1] - gamma[i]))[static_cast<std::size_t>(part)] *
                   std::sin(angle * pi / 180);
          },
          low, high);
  }
  return all > 0 ? std::sqrt(off / all) : 0;
}

}  // namespace catoptric::design

#include "rayfiles/ray_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/float_traps.h"
#include "base/ordered_sum.h"
#include "rayfiles/detail/ray_fault.h"

namespace catoptric::rayfiles {
namespace {

using detail::RayFault;

/// What a pass over the rays gathers, one by one in their order.
class Gathering {
 public:
  explicit Gathering(const RaySet& rays) : rays_(rays) {}

  void add(std::uint64_t i) {
    const SourceRay ray = rays_.as_stored(i);
    if (const auto fault = detail::fault_of(ray)) return keep(*fault, i);
    least_flux_ = std::min(least_flux_, ray.flux);
    greatest_flux_ = std::max(greatest_flux_, ray.flux);
    if (!(ray.flux > 0)) return;
    ++lit_;
    total_.add(ray.flux);
    const double weight = ray.flux / ray.direction.norm();
    for (int axis = 0; axis < 3; ++axis) directions_[axis].add(weight * ray.direction[axis]);
    extremes_.add(ray.position_mm);
  }

  RayCheck result() const {
    RayCheck check;
    check.findings = findings_;
    check.notes = rays_.header().notes;
    RayStatistics& all = check.statistics;
    if (lit_ == 0) {
      check.findings.push_back(
          {{"no ray carries flux", rays_.header().name, "a source gives light", "export the file anew"},
           rays_.count()});
      all.lowest_mm = all.highest_mm = all.mean_direction = Vector3::Zero();
      return check;
    }
    all.lit = lit_;
    all.total_flux = total_.value();
    all.least_flux = least_flux_;
    all.greatest_flux = greatest_flux_;
    all.equal_flux = findings_.empty() && least_flux_ == greatest_flux_;
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::size_t>(axis);
      all.lowest_mm[axis] = extremes_.lowest_mm(place)[axis];
      all.highest_mm[axis] = extremes_.highest_mm(place)[axis];
      all.mean_direction[axis] = directions_[axis].value() / all.total_flux;
    }
    all.sphere.centre_mm = extremes_.centre_mm();
    return check;
  }

 private:
  void keep(RayFault fault, std::uint64_t i) {
    const ErrorParts parts = detail::words(fault);
    const auto known = std::find_if(findings_.begin(), findings_.end(), [&](const RayFinding& finding) {
      return finding.parts.what == parts.what;
    });
    if (known != findings_.end()) {
      ++known->count;
      return;
    }
    findings_.push_back({parts, 1});
    findings_.back().parts.where = rays_.place(i, detail::field_of(fault));
  }

  const RaySet& rays_;
  std::vector<RayFinding> findings_;
  std::uint64_t lit_ = 0;
  double least_flux_ = std::numeric_limits<double>::max();
  double greatest_flux_ = 0;
  CompensatedSum total_, directions_[3];
  ExtremePoints extremes_;
};

double farthest_mm(const RaySet& rays, const Vector3& centre_mm) {
  double squared = 0;
  for (std::uint64_t i = 0; i < rays.count(); ++i) {
    const SourceRay ray = rays.as_stored(i);
    if (!detail::fault_of(ray) && ray.flux > 0)
      squared = std::max(squared, (ray.position_mm - centre_mm).squaredNorm());
  }
  constexpr double roundings =
      1 + 8 * std::numeric_limits<double>::epsilon();  // no point may be left outside
  return roundings * std::sqrt(squared);
}

void compare_total(const RaySetHeader& header, RayCheck& check) {
  const double stated = header.total_flux.value_or(0);
  RayStatistics& all = check.statistics;
  if (!header.total_flux || all.lit == 0) return;
  if (stated > 0) all.total_deviation_rel = (all.total_flux - stated) / stated;
  if (stated > 0 && std::abs(*all.total_deviation_rel) <= total_flux_tolerance) return;
  check.notes.push_back(fmt::format("the rays' fluxes add up to {:.6g} {}, the header says {:.6g} {}",
                                    all.total_flux, flux_unit(header.quantity), stated,
                                    flux_unit(header.quantity)));
}

}  // namespace

RayCheck check_rays(const RaySet& rays) {
  const UntrappedFloats numbers_may_be_nan;
  rays.require_unchanged();
  Gathering gathering(rays);
  for (std::uint64_t i = 0; i < rays.count(); ++i) gathering.add(i);
  RayCheck check = gathering.result();
  rays.require_unchanged();
  if (check.statistics.lit > 0)
    check.statistics.sphere.radius_mm = farthest_mm(rays, check.statistics.sphere.centre_mm);
  compare_total(rays.header(), check);
  rays.require_unchanged();
  return check;
}

void require_sound(const RayCheck& check) {
  if (check.sound()) return;
  const RayFinding& first = check.findings.front();
  ErrorParts parts = first.parts;
  if (first.count > 1) parts.why += fmt::format(" ({} rays break this)", first.count);
  throw InputError(parts);
}

}  // namespace catoptric::rayfiles

#include "sim/fresnel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>

#include "base/contract.h"

namespace catoptric::sim {
namespace {

/// Both media alike are one where Fresnel's amplitudes are written with w = N cos(angle beyond), N the index
/// beyond: across r_s = (1 - N^2) / (c + w)^2, along r_p = r_s (c w - s^2) / (c w + s^2). Nothing cancels in
/// r_s, and no square of N is formed, which might overflow.
template <typename Index>
PolarisedReflectance reflectances(double c, double s_squared, const Index& n, const Index& w) {
  const double across = (std::abs(1.0 - n) / std::abs(c + w)) * (std::abs(1.0 + n) / std::abs(c + w));
  const double along = across * (std::abs(c * w - s_squared) / std::abs(c * w + s_squared));
  return {across * across, along * along};
}

/// N times the cosine beyond the boundary, by whichever of sine and cosine before it is the smaller, which is
/// the more exact; no square of N is formed. Negative or 0: reflection is total.
double depth_beyond(double cosine, double sine, double n) {
  if (cosine >= sine) return n > sine ? std::sqrt(n - sine) * std::sqrt(n + sine) : -1;
  if (n >= 1) return std::hypot(std::sqrt(n - 1) * std::sqrt(n + 1), cosine);
  const double critical_cosine = std::sqrt((1 - n) * (1 + n));
  return cosine > critical_cosine ? std::sqrt((cosine - critical_cosine) * (cosine + critical_cosine)) : -1;
}

}  // namespace

PolarisedReflectance polarised_reflectance(double cosine, double index_ratio) {
  CATOPTRIC_EXPECTS(cosine >= 0 && cosine <= 1);
  CATOPTRIC_EXPECTS(index_ratio > 0 && std::isfinite(index_ratio));
  if (index_ratio == 1) return {0, 0};
  const double s_squared = (1 - cosine) * (1 + cosine);
  const double depth = depth_beyond(cosine, std::sqrt(s_squared), index_ratio);
  return depth > 0 ? reflectances(cosine, s_squared, index_ratio, depth) : PolarisedReflectance{1, 1};
}

double dielectric_reflectance(double cosine, double index_ratio) {
  return polarised_reflectance(cosine, index_ratio).mean();
}

double conductor_reflectance(double cosine, double index, double extinction) {
  CATOPTRIC_EXPECTS(cosine >= 0 && cosine <= 1);
  CATOPTRIC_EXPECTS(index > 0 && std::isfinite(index) && extinction >= 0 && std::isfinite(extinction));
  if (extinction == 0) return dielectric_reflectance(cosine, index);
  const std::complex<double> n(index, extinction);
  const double s_squared = (1 - cosine) * (1 + cosine), s = std::sqrt(s_squared);
  // n^2 - s^2 by its factors; 1 - s keeps the cosine that it would round away at grazing incidence.
  const double one_less_s = cosine * cosine / (1 + s);
  const std::complex<double> w =
      std::sqrt(std::complex(index - 1 + one_less_s, extinction)) * std::sqrt(n + s);
  return reflectances(cosine, s_squared, n, w).mean();
}

std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double index_ratio) {
  CATOPTRIC_EXPECTS(index_ratio > 0 && std::isfinite(index_ratio));
  const double against = -direction.dot(normal);
  const Vector3 facing = against < 0 ? Vector3(-normal) : normal;
  const double cosine = std::abs(against);
  const Vector3 along_surface = direction + cosine * facing;
  const double depth = depth_beyond(cosine, along_surface.norm(), index_ratio);
  if (!(depth > 0)) return std::nullopt;
  return (along_surface - depth * facing).stableNormalized();
}

}  // namespace catoptric::sim

#include "rayfiles/ray_picker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/contract.h"
#include "base/errors.h"
#include "base/float_traps.h"
#include "base/ordered_sum.h"

namespace catoptric::rayfiles {
namespace {

constexpr double below_one = 1 - 0x1p-53;

}  // namespace

RayPicker::RayPicker(std::shared_ptr<const RaySet> rays) : rays_(std::move(rays)) {
  rays_->require_unchanged();
  if (all_equal())
    total_ = static_cast<double>(rays_->count()) * rays_->flux(0);
  else
    build_table();
  rays_->require_unchanged();
  if (!(total_ > 0))
    throw InputError(
        {"no ray carries flux", rays_->header().name, "a source gives light", "export the file anew"});
}

double RayPicker::sound_flux(std::uint64_t i) const {
  const UntrappedFloats fluxes_may_be_nan;
  const double flux = rays_->flux(i);
  if (!(flux >= 0 && std::isfinite(flux)))
    throw InputError({fmt::format("{} is no flux", flux), rays_->place(i, RayField::flux),
                      "fluxes are finite and 0 or more", "export the file anew"});
  return flux;
}

bool RayPicker::all_equal() const {
  const double first = sound_flux(0);
  for (std::uint64_t i = 1; i < rays_->count(); ++i)
    if (sound_flux(i) != first) return false;
  return true;
}

void RayPicker::build_table() {
  const std::uint64_t count = rays_->count();
  sums_.reserve((count + block_size - 1) / block_size + 1);
  sums_.push_back(0);
  CompensatedSum sum;
  for (std::uint64_t i = 0; i < count; ++i) {
    sum.add(sound_flux(i));
    // A compensated sum may step back by a rounding, which must not turn the order of rays.
    if ((i + 1) % block_size == 0 || i + 1 == count) sums_.push_back(std::max(sums_.back(), sum.value()));
  }
  total_ = sums_.back();
}

PickedRay RayPicker::pick(double u) const {
  CATOPTRIC_EXPECTS(u >= 0 && u < 1);
  if (sums_.empty()) {
    const double place = u * static_cast<double>(rays_->count());
    const double whole = std::min(std::floor(place), static_cast<double>(rays_->count() - 1));
    return {static_cast<std::uint64_t>(whole), std::min(place - whole, below_one)};
  }
  const double flux = std::min(u * total_, std::nextafter(total_, 0.0));
  const auto next = std::upper_bound(sums_.begin(), sums_.end(), flux);
  const auto block = static_cast<std::uint64_t>(next - sums_.begin()) - 1;
  return pick_in_block(block, flux - sums_[block]);
}

PickedRay RayPicker::pick_in_block(std::uint64_t block, double rest_flux) const {
  const std::uint64_t end = std::min((block + 1) * block_size, rays_->count());
  double before = 0;
  std::uint64_t last_lit = block * block_size;
  for (std::uint64_t i = block * block_size; i < end; ++i) {
    const double flux = rays_->flux(i);
    if (!(flux > 0)) continue;
    if (rest_flux < before + flux) return {i, std::min((rest_flux - before) / flux, below_one)};
    before += flux;
    last_lit = i;
  }
  return {last_lit, below_one};  // the block's own sum is smaller than the table's by roundings
}

}  // namespace catoptric::rayfiles

#include "rayfiles/ray_file_writer.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "base/contract.h"
#include "base/errors.h"
#include "base/float_traps.h"
#include "rayfiles/detail/ray_fault.h"

namespace catoptric::rayfiles {

RayFileWriter::RayFileWriter(std::filesystem::path path, RayFileHeader header)
    : path_(std::move(path)), header_(std::move(header)), pending_(path_) {
  columns_ = std::visit([](const auto& any) { return rayfiles::columns(any); }, header_);
  find_fluxes();
  const std::string bytes = header_bytes();
  out_.open(pending_.temporary_path(), std::ios::binary | std::ios::trunc);
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require_written();
}

void RayFileWriter::find_fluxes() {
  const auto* const zemax = std::get_if<ZemaxHeader>(&header_);
  const bool watts = !zemax || zemax->flux == ZemaxFlux::watts;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i] == (zemax ? "flux" : "phi"))
      fluxes_.push_back({i, watts ? LightQuantity::radiant : LightQuantity::luminous, {}});
    else if (!zemax && columns_[i] == "Tri_Y")
      fluxes_.push_back({i, LightQuantity::luminous, {}});
  if (fluxes_.empty())
    throw InputError(
        {"rays would have no flux", path_.string(), "radiant flux, luminous flux or both are written", ""});
}

void RayFileWriter::add(std::span<const float> ray) {
  const UntrappedFloats numbers_may_be_nan;
  CATOPTRIC_EXPECTS(ray.size() == columns_.size());
  for (FluxColumn& flux : fluxes_) {
    const SourceRay seen{{ray[0], ray[1], ray[2]}, {ray[3], ray[4], ray[5]}, ray[flux.column]};
    if (const auto fault = detail::fault_of(seen)) {
      ErrorParts parts = detail::words(*fault);
      parts.where = fmt::format("{}, ray {} (the first is 0)", path_.string(), count_);
      throw InputError(parts);
    }
    flux.sum.add(ray[flux.column]);
  }
  out_.write(reinterpret_cast<const char*>(ray.data()), static_cast<std::streamsize>(ray.size_bytes()));
  require_written();
  ++count_;
}

void RayFileWriter::fill_in() {
  if (auto* const zemax = std::get_if<ZemaxHeader>(&header_)) {
    zemax->ray_count = static_cast<std::uint32_t>(count_);
    const auto sum = static_cast<float>(fluxes_.front().sum.value());
    if (zemax->source_flux == 0) zemax->source_flux = sum;
    if (zemax->ray_set_flux == 0) zemax->ray_set_flux = sum;
    return;
  }
  auto& tm25 = std::get<Tm25Header>(header_);
  tm25.ray_count = count_;
  for (const FluxColumn& flux : fluxes_) {
    auto& total = flux.quantity == LightQuantity::radiant ? tm25.radiant_flux : tm25.luminous_flux;
    if (!total) total = static_cast<float>(flux.sum.value());
  }
}

void RayFileWriter::commit() {
  if (count_ == 0) throw InputError({"there are no rays", path_.string(), "a source has at least one", ""});
  if (std::holds_alternative<ZemaxHeader>(header_) && count_ > most_zemax_rays)
    throw InputError({fmt::format("{} rays are too many", count_), path_.string(),
                      "Zemax files hold 4,000,000,000 at most", "write TM-25-13 (.tm25ray)"});
  fill_in();
  const std::string bytes = header_bytes();
  out_.seekp(0);
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out_.close();
  require_written();
  pending_.commit();
}

std::string RayFileWriter::header_bytes() const {
  if (const auto* const zemax = std::get_if<ZemaxHeader>(&header_)) return zemax_header_bytes(*zemax);
  return tm25_header_bytes(std::get<Tm25Header>(header_));
}

void RayFileWriter::require_written() {
  if (!out_)
    throw IoError({"cannot write the file", path_.string(), std::strerror(errno != 0 ? errno : EIO),
                   "check the folder's permissions and free space"});
}

}  // namespace catoptric::rayfiles

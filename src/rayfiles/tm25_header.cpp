#include "rayfiles/tm25_header.h"

#include "rayfiles/detail/little_endian.h"

namespace catoptric::rayfiles {

std::vector<std::string> columns(const Tm25Header& header) {
  std::vector<std::string> names{"x", "y", "z", "kx", "ky", "kz"};
  if (header.has_radiant_flux) names.push_back("phi");
  if (header.has_wavelength) names.push_back("lambda");
  if (header.has_luminous_flux) names.push_back("Tri_Y");
  if (header.has_stokes)
    for (const char* name : {"S1", "S2", "S3", "PolEllipseX", "PolEllipseY", "PolEllipseZ"})
      names.push_back(name);
  if (header.has_tristimulus)
    for (const char* name : {"Tri_X", "Tri_Z"}) names.push_back(name);
  if (header.has_spectrum_index) names.push_back("spectrumIdx");
  names.insert(names.end(), header.additional_columns.begin(), header.additional_columns.end());
  return names;
}

bool looks_like_tm25(std::span<const std::byte> bytes) {
  constexpr std::string_view type = "TM25";
  return bytes.size() >= type.size() && std::memcmp(bytes.data(), type.data(), type.size()) == 0;
}

}  // namespace catoptric::rayfiles

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/light_units.h"
#include "base/ray.h"

namespace catoptric::rayfiles {

/// What is known of a set of rays before any of them is read.
struct RaySetHeader {
  std::string name;                     ///< of the file, for messages
  std::string format;                   ///< "IES TM-25-13", "Zemax binary"
  std::string title;                    ///< the light source, as the file calls it; UTF-8
  LightQuantity quantity{};             ///< of the fluxes that are read
  std::optional<double> total_flux;     ///< W or lm as the file states it; the rays' sum may be another
  std::uint64_t count = 0;              ///< of rays, at least 1
  std::string length_unit = "mm";       ///< of the file; rays are given in mm
  double millimetres_per_unit = 1;      ///< of that unit
  std::optional<double> wavelength_nm;  ///< where all rays have the same
  std::vector<std::string> notes;       ///< sentences on what is odd or left out
};

/// A ray of a light source with the part of its flux that it carries.
struct SourceRay {
  Vector3 position_mm;
  Vector3 direction;
  double flux;  ///< W or lm
};

/// The parts of a ray, for messages.
enum class RayField { position, direction, flux };

/// A light source as a list of rays, in a file that is not loaded or in memory. Safe to read from many
/// threads.
class RaySet {
 public:
  virtual ~RaySet() = default;
  virtual const RaySetHeader& header() const = 0;

  /// A ray with its direction at the length it was stored with; nothing is checked.
  /// @in    i in [0, count())
  virtual SourceRay as_stored(std::uint64_t i) const = 0;

  /// The flux of a ray, for passes that need no more of it.  @in i in [0, count())
  virtual double flux(std::uint64_t i) const = 0;

  /// Where a ray's field stands, for messages: file, number of the ray, byte.
  virtual std::string place(std::uint64_t i, RayField field) const = 0;

  /// @fails InputError when what the rays are read from is no longer what was opened
  virtual void require_unchanged() const {}

  std::uint64_t count() const { return header().count; }

  /// A ray with a unit direction. Of rays that check_rays() finds fault with, the fault comes along: a
  /// direction of no length stays one, what is not finite spoils what is computed from it.
  /// @in    i in [0, count())
  SourceRay ray(std::uint64_t i) const;
};

}  // namespace catoptric::rayfiles

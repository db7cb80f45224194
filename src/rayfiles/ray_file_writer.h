#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/ordered_sum.h"
#include "rayfiles/ray_file.h"

namespace catoptric::rayfiles {

/// Writes a ray file ray by ray; the file appears under its name when commit() is called, or not at all. The
/// same header and rays give the same bytes.
class RayFileWriter {
 public:
  /// @in    header: of the format to write. Its number of rays is filled in; so are total fluxes of
  ///        TM-25 that are left out though rays have them, and Zemax's source_flux and ray_set_flux if 0
  /// @fails IoError when the file cannot be created; InputError as tm25_header_bytes()
  RayFileWriter(std::filesystem::path path, RayFileHeader header);

  /// The numbers of a ray that add() expects, in order.
  const std::vector<std::string>& columns() const { return columns_; }

  /// Appends a ray, to the bit.
  /// @in    ray: as many numbers as columns(), in the file's units
  /// @fails InputError for what check_rays() would find; IoError when the disk is full
  /// @cost  O(1) memory
  void add(std::span<const float> ray);

  std::uint64_t count() const { return count_; }

  /// @fails InputError when there are no rays; IoError
  void commit();

 private:
  /// A column of fluxes, and their sum.
  struct FluxColumn {
    std::size_t column;
    LightQuantity quantity;
    CompensatedSum sum;
  };
  void find_fluxes();
  void fill_in();
  std::string header_bytes() const;
  void require_written();

  std::filesystem::path path_;
  RayFileHeader header_;
  std::vector<std::string> columns_;
  std::vector<FluxColumn> fluxes_;
  std::uint64_t count_ = 0;
  PendingFile pending_;
  std::ofstream out_;
};

}  // namespace catoptric::rayfiles

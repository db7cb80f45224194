#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "rayfiles/detail/mapped_file.h"
#include "rayfiles/ray_set.h"
#include "rayfiles/tm25_header.h"
#include "rayfiles/zemax_header.h"

namespace catoptric::rayfiles {

/// A header with all that its format says.
using RayFileHeader = std::variant<Tm25Header, ZemaxHeader>;

/// A ray file of any size: its rays are read from the disk when they are asked for, and stay there.
/// A file that another program cuts short while it is open may end the process (detail/mapped_file.h).
class RayFile final : public RaySet {
 public:
  /// Opens a file in the format that its first bytes say. Rays are not looked at: check_rays().
  /// @in    wanted: which flux to read where a TM-25 file has both; radiant flux when left out
  /// @fails InputError with file, byte, field and rule: no such file, another format, an unsound header,
  /// fewer
  ///        rays than it says, or a wanted flux that is not there. Bytes behind the last ray are a note
  /// @cost  O(header): the size of the file does not matter
  static std::shared_ptr<const RayFile> open(const std::filesystem::path& file,
                                             std::optional<LightQuantity> wanted = {});

  const RaySetHeader& header() const override { return header_; }
  SourceRay as_stored(std::uint64_t i) const override;
  double flux(std::uint64_t i) const override { return stored(i, flux_column_); }
  std::string place(std::uint64_t i, RayField field) const override;
  void require_unchanged() const override { file_.require_unchanged(); }

  const RayFileHeader& file_header() const { return file_header_; }

  /// The names of a ray's numbers; the first six are position and direction.
  const std::vector<std::string>& columns() const { return columns_; }

  /// A number as it stands in the file, in the file's unit.  @in column in [0, columns().size())
  float stored(std::uint64_t i, std::size_t column) const;

 private:
  explicit RayFile(const std::filesystem::path& file) : file_(file) {}
  void read_header(std::optional<LightQuantity> wanted);
  void use(Tm25Reading reading, std::optional<LightQuantity> wanted);
  void use(ZemaxReading reading, std::optional<LightQuantity> wanted);
  void require_all_rays();
  [[noreturn]] void refuse_flux(LightQuantity wanted) const;
  [[noreturn]] void refuse_format() const;
  const std::byte* bytes_of(std::uint64_t i) const;

  detail::MappedFile file_;
  RayFileHeader file_header_;
  RaySetHeader header_;
  std::vector<std::string> columns_;
  std::size_t flux_column_ = 6;
  std::uint64_t first_ray_byte_ = 0;
  std::uint64_t ray_size_ = 0;  ///< in bytes
};

}  // namespace catoptric::rayfiles

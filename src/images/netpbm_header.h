#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace catoptric::images {

/// The words of a Netpbm file, one after the other: numbers between blanks, with comments from # to the end
/// of the line.
class NetpbmWords {
 public:
  /// @in    bytes from behind the magic number; name: of the file, for messages
  NetpbmWords(std::string_view bytes, std::string name) : left_(bytes), name_(std::move(name)) {}

  /// The next word; empty at the end.
  std::string_view next();
  /// The next word as a whole number.
  /// @in    what: "width", for messages  @fails InputError when it is none, or outside [least, greatest]
  std::size_t integer(std::string_view what, std::size_t least, std::size_t greatest);
  /// Takes the one blank that stands between header and pixels.  @fails InputError when there is none
  void end_header();
  /// What has not been read.
  std::string_view left() const { return left_; }

 private:
  std::string_view left_;
  std::string name_;
};

/// Refuses a picture of more pixels than are taken.  @fails InputError
void require_few_pixels(std::size_t columns, std::size_t rows, const std::string& name);
/// Refuses pixels that are not as many bytes as the header says.  @fails InputError
void require_bytes(std::size_t found, std::size_t expected, const std::string& name);
/// "row 3, column 5" of a pixel that is counted from 0.
std::string place_of(std::size_t row, std::size_t column);

}  // namespace catoptric::images

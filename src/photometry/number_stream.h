#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::photometry {

/// A file of more values than this is refused before room is made for them.
inline constexpr std::size_t most_values = 10'000'000;

/// Numbers one after the other, wrapped over lines at will; blanks and commas separate them.
class NumberStream {
 public:
  /// @in    first_line: number of the text's first line in the file, counted from 1
  NumberStream(std::string_view text, std::string name, std::size_t first_line)
      : rest_(text), name_(std::move(name)), line_(first_line) {}

  /// The next number.
  /// @in    field: what it means, for the message
  /// @fails InputError with file, line and field where the text ends or no finite number stands
  double next(std::string_view field);

  /// The next number, which is whole and lies in [least, greatest].
  int next_count(std::string_view field, int least, int greatest);

  /// Refuses to go on when so many more numbers are too many, or more than the text has room for. To be asked
  /// before room is made for them.
  void require_room(std::size_t count, std::string_view field) const;

  /// So many angles, ascending, in degrees.
  std::vector<double> next_angles(std::size_t count, std::string_view field);

  /// Whether nothing but separators is left.
  bool at_end();

  /// The next word, whatever it is; empty at the end.
  std::string_view next_word();

  /// Refuses the number that was read last.
  [[noreturn]] void refuse(std::string what, std::string_view field, std::string why,
                           std::string hint = "") const;

 private:
  void skip_separators();

  std::string_view rest_;
  std::string name_;
  std::size_t line_;
};

}  // namespace catoptric::photometry

#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::design {

/// What a key of a scene or study file may hold.
enum class KeyType { text, choice, integer, number, boolean, numbers, points, texts };

/// How the number is to be read: lengths are in the scene's unit.
enum class Quantity { none, length, power_w, flux_lm, irradiance };

/// Greatest length a scene may name, in its own unit: wide enough for 1 um parts in metres and 100 km fields
/// in mm.
inline constexpr double farthest = 1e12;
/// Least size it may name: a millionth of what makes sense, while squares and cubes keep all their digits.
inline constexpr double nearest = 1e-12;

/// Greatest irradiance (W/m^2, lx) or intensity (W/sr, cd) that may be wanted, and weight of a place.
inline constexpr double greatest_irradiance_w_per_m2 = 1e15, greatest_weight_of_a_place = 1e12;

/// One key. The table of these validates files, fills in defaults, writes scenes out and makes the reference.
struct Key {
  std::string_view path;  ///< dotted; a star stands for any name, which may have dots itself
  KeyType type;
  Quantity quantity = Quantity::none;
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  bool least_excluded = false;
  std::vector<std::string_view> choices = {};
  std::size_t count = 0;           ///< how many numbers a list holds; 0: any
  std::string_view standard = {};  ///< TOML text of the value it has when left out; empty: none, or one that
                                   ///< follows from other keys
  std::string_view meaning = {};
};

/// All keys of a scene file, in the order they are written out.
std::span<const Key> scene_keys();

/// All keys of a study file.
std::span<const Key> study_keys();

/// The key whose path fits, or null.
const Key* find_key(std::span<const Key> keys, std::string_view path);

/// The known path most like a mistyped one, or empty when nothing is near.
/// @from  Damerau-Levenshtein distance, at most a third of the length
std::string nearest_path(std::span<const Key> keys, std::string_view path);

/// The choice of a key most like a mistyped one, or empty when nothing is near.
std::string nearest_choice(const Key& key, std::string_view value);

/// Distance in insertions, deletions, substitutions and swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// All keys in words, a line or two each: what `--keys` prints.
std::string reference(std::span<const Key> keys);

/// What the key asks for in words: "a number > 0, in the scene's unit of length".
std::string rule(const Key& key);

}  // namespace catoptric::design

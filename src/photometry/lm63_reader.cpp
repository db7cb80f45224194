#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/errors.h"
#include "photometry/file_text.h"
#include "photometry/lm63.h"
#include "photometry/lm63_angles.h"
#include "photometry/lm63_header.h"
#include "photometry/number_stream.h"

namespace catoptric::photometry {
namespace {

bool is_word(std::string_view text, std::string_view word) {
  return std::equal(text.begin(), text.end(), word.begin(), word.end(),
                    [](unsigned char a, unsigned char b) { return std::toupper(a) == b; });
}

double next_positive(NumberStream& numbers, std::string_view field, std::string hint = "") {
  const double value = numbers.next(field);
  if (!(value > 0)) numbers.refuse(fmt::format("it is {}", value), field, "it is above 0", std::move(hint));
  return value;
}

Lm63Tilt read_tilt(NumberStream& numbers) {
  constexpr int most_pairs = 10'000;
  Lm63Tilt tilt;
  tilt.lamp_geometry = numbers.next_count("lamp-to-luminaire geometry", 1, 3);
  const int pairs = numbers.next_count("number of tilt angles", 1, most_pairs);
  tilt.angles_deg = numbers.next_angles(static_cast<std::size_t>(pairs), "tilt angles");
  numbers.require_room(static_cast<std::size_t>(pairs), "tilt factors");
  for (int i = 0; i < pairs; ++i) {
    tilt.factors.push_back(numbers.next("tilt factors"));
    if (!(tilt.factors.back() >= 0))
      numbers.refuse(fmt::format("it is {}", tilt.factors.back()), "tilt factors", "it is not negative");
  }
  return tilt;
}

/// What a file says that stands beside the IES file; never one elsewhere.
Lm63Tilt read_tilt_file(const Lm63Header& header, const std::string& name,
                        const std::filesystem::path& folder, std::vector<std::string>& notes) {
  const std::string where = fmt::format("{}:{}, TILT", name, header.rest_line - 1);
  if (header.version == Lm63Version::of_2019)
    throw InputError({fmt::format("TILT names \"{}\"", cited(header.tilt)), where,
                      "in 2019 it is TILT=NONE or TILT=INCLUDE", "put the tilt's values into the file"});
  const std::filesystem::path tilt_name(header.tilt);
  const bool plain = !header.tilt.empty() && header.tilt.find_first_of("/\\") == std::string::npos &&
                     header.tilt != "." && header.tilt != "..";
  std::error_code ignored;
  if (!plain || folder.empty() || !std::filesystem::is_regular_file(folder / tilt_name, ignored))
    throw InputError(
        {fmt::format("TILT names the file \"{}\", which is not beside this one", cited(header.tilt)), where,
         "a tilt file lies in the same folder and is named without a folder",
         "copy the file there, or write TILT=NONE to leave the tilt out"});
  const std::string text = read_photometric_text(folder / tilt_name, notes);
  NumberStream numbers(text, (folder / tilt_name).string(), 1);
  return read_tilt(numbers);
}

/// The two lines of settings before the angles.
struct Counts {
  int vertical, horizontal;
};

Counts read_settings(Lm63File& file, NumberStream& numbers, std::vector<std::string>& notes) {
  file.lamp_count = numbers.next_count("number of lamps", 1, 1'000'000);
  const double lumens = numbers.next("lumens per lamp");
  if (lumens != -1 && !(lumens > 0))
    numbers.refuse(fmt::format("it is {}", lumens), "lumens per lamp", "it is above 0, or -1",
                   "-1 stands for absolute photometry");
  if (lumens != -1) file.lumens_per_lamp = lumens;
  file.multiplier = next_positive(numbers, "candela multiplier");
  Counts counts{};
  counts.vertical = numbers.next_count("number of vertical angles", 2, static_cast<int>(most_values));
  counts.horizontal = numbers.next_count("number of horizontal angles", 1, static_cast<int>(most_values));
  const auto values = static_cast<std::size_t>(counts.vertical) * static_cast<std::size_t>(counts.horizontal);
  if (values > most_values)
    numbers.refuse(fmt::format("{} vertical by {} horizontal angles", counts.vertical, counts.horizontal),
                   "number of horizontal angles", fmt::format("at most {} values are read", most_values));
  file.type = static_cast<PhotometricType>(numbers.next_count("photometric type", 1, 3));
  file.units = static_cast<Lm63Units>(numbers.next_count("units type", 1, 2));
  file.width = numbers.next("luminous opening's width");
  file.length = numbers.next("luminous opening's length");
  file.height = numbers.next("luminous opening's height");
  file.ballast_factor = next_positive(numbers, "ballast factor");
  file.ballast_lamp_factor = numbers.next("ballast-lamp factor");
  if (file.ballast_lamp_factor == 0 && file.version >= Lm63Version::of_1995) {
    file.ballast_lamp_factor = 1;
    notes.push_back("The ballast-lamp factor is 0; 1 was taken, its only value since 1995.");
  }
  if (!(file.ballast_lamp_factor > 0))
    numbers.refuse(fmt::format("it is {}", file.ballast_lamp_factor), "ballast-lamp factor", "it is above 0");
  file.input_w = numbers.next("input watts");
  if (!(file.input_w >= 0))
    numbers.refuse(fmt::format("it is {}", file.input_w), "input watts", "they are not negative");
  return counts;
}

void read_candela(Lm63File& file, NumberStream& numbers) {
  const std::size_t rows = file.vertical_deg.size();
  const std::size_t count = rows * file.horizontal_deg.size();
  numbers.require_room(count, "candela values");
  file.candela.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    file.candela[i] = numbers.next("candela values");
    if (!(file.candela[i] >= 0))
      numbers.refuse(fmt::format("it is {} cd", file.candela[i]),
                     fmt::format("candela value at vertical angle {}, horizontal angle {}",
                                 file.vertical_deg[i % rows], file.horizontal_deg[i / rows]),
                     "intensities are not negative");
  }
}

/// A file may state its first plane a second time, at 360 degrees.
void check_closing_plane(const Lm63File& file, const NumberStream& numbers, std::vector<std::string>& notes) {
  if (file.type != PhotometricType::c || plane_symmetry(file.horizontal_deg) != PlaneSymmetry::none_closed)
    return;
  const std::size_t rows = file.vertical_deg.size();
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < rows; ++i)
    difference =
        std::max(difference, std::abs(file.candela[i] - file.candela[file.candela.size() - rows + i]));
  for (const double value : file.candela) largest = std::max(largest, value);
  constexpr double harmless = 0.05;  // of the largest: what a second measurement may differ by
  if (difference > harmless * largest)
    numbers.refuse(
        fmt::format("the plane at 360 degrees differs by {} from the one at 0 degrees", difference),
        "candela values", "both are the same plane", "check the order of the planes");
  if (difference > 0)
    notes.push_back(fmt::format(
        "The plane at 360 degrees differs by up to {} from the one at 0 degrees, which was taken.",
        difference));
}

void check_end(NumberStream& numbers, std::vector<std::string>& notes) {
  if (numbers.at_end()) return;
  const std::string_view word = numbers.next_word();
  const bool number = word.find_first_not_of("0123456789.+-eE") == std::string_view::npos;
  if (number)
    numbers.refuse(fmt::format("\"{}\" follows the last candela value", cited(word)), "candela values",
                   "there is one value for each pair of angles", "check the counts of angles");
  notes.push_back("Text behind the last candela value was left out.");
}

}  // namespace

Lm63Reading parse_lm63(std::string_view bytes, const std::string& name, const std::filesystem::path& folder) {
  Lm63Reading reading;
  const std::string text = decoded(bytes, name, reading.notes);
  Lm63Header header = read_lm63_header(text, name, reading.notes);
  Lm63File& file = reading.file;
  file.version = header.version;
  NumberStream numbers(header.rest, name, header.rest_line);
  if (is_word(header.tilt, "INCLUDE"))
    file.tilt = read_tilt(numbers);
  else if (!is_word(header.tilt, "NONE"))
    file.tilt = read_tilt_file(header, name, folder, reading.notes);
  if (file.tilt)
    reading.notes.push_back(
        "The tilt's factors were not applied: intensities are those of the luminaire as it was measured.");
  file.keywords = std::move(header.keywords);
  const Counts counts = read_settings(file, numbers, reading.notes);
  read_lm63_angles(file, static_cast<std::size_t>(counts.vertical),
                   static_cast<std::size_t>(counts.horizontal), numbers, reading.notes);
  read_candela(file, numbers);
  check_closing_plane(file, numbers, reading.notes);
  const double largest = *std::max_element(file.candela.begin(), file.candela.end());
  constexpr double too_bright = 1e100;  // as IntensityTable has it
  if (!(largest * candela_factor(file) <= too_bright))
    numbers.refuse(fmt::format("the largest value is {}, all factors {}", largest, candela_factor(file)),
                   "candela multiplier", "no light has more than 1e100 cd");
  check_end(numbers, reading.notes);
  return reading;
}

Lm63Reading read_lm63(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  const std::string text = read_photometric_text(file, notes);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  Lm63Reading reading = parse_lm63(text, file.string(), folder);
  reading.notes.insert(reading.notes.begin(), notes.begin(), notes.end());
  return reading;
}

}  // namespace catoptric::photometry

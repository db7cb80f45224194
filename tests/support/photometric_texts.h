#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/intensity_table.h"
#include "base/random_stream.h"

namespace catoptric::test {

/// A text with the first place of `from` replaced; empty when there is none, so that the test sees it.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto place = text.find(from);
  return place == std::string::npos ? std::string() : text.replace(place, from.size(), to);
}

/// The lines of a text whose line `number` (from 1) is another.
inline std::string with_line(const std::string& text, std::size_t number, const std::string& line) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
  return text.substr(0, begin) + line + text.substr(text.find('\n', begin));
}

/// An IES file of three angles; `lamps` is what stands from the number of lamps to the input watts.
inline std::string small_ies(const std::string& first_line, const std::string& lamps,
                             const std::string& angles_and_candela) {
  return first_line + "[TEST] 1\n[TESTLAB] ours\n[ISSUEDATE] 2026-05-17\n[MANUFAC] us\nTILT=NONE\n" + lamps +
         "\n" + angles_and_candela + "\n";
}

/// An IES file that breaks no rule and gives no note: 2 planes of a quadrant, 3 angles.
inline std::string sound_ies() {
  return small_ies("IESNA:LM-63-2002\n", "1 1000 1 3 2 1 2 0.1 0.2 0\n1 1 10",
                   "0 45 90\n0 90\n100 50 0\n200 60 10");
}

/// A EULUMDAT file that breaks no rule and gives no note: Isym 4, 4 planes 90 degrees apart, 3 angles.
/// Line 42 is the second C angle, line 48 the first intensity.
inline std::string sound_ldt() {
  std::string text = "company\n3\n4\n4\n90\n3\n45\nreport\nname\nnumber\nfile\ndate\n";  // 12
  text += "200\n100\n50\n180\n90\n10\n11\n12\n13\n100\n80\n1\n0\n";                      // 25
  text += "1\n2\nLED\n2000\n4000\n80\n25\n";                                             // 32
  for (int i = 0; i < 10; ++i) text += "0.5\n";                                          // 42
  return text + "0\n90\n180\n270\n0\n45\n90\n100\n50\n0\n200\n60\n10\n";
}

/// A table of random size and values, one plane or several, symmetric or not, evenly spaced or not.
inline IntensityTable random_table(std::uint64_t index) {
  RandomStream random(7, Purpose::test, index);
  const auto below = [&](int end) { return static_cast<int>(random.uniform() * end); };
  const double first = below(3) == 0 ? 90 : 0;
  const double last = first == 90 || below(2) == 0 ? 180 : 90;
  std::vector<double> gamma{first};
  const int steps = 1 + below(12);
  const bool even = below(2) == 0;
  for (int i = 1; i < steps; ++i)
    gamma.push_back(first + (last - first) * (i + (even ? 0 : random.uniform() / 2)) / steps);
  gamma.push_back(last);
  const int kind = below(5);  // one plane, any planes, or one of three symmetries
  const int planes = kind == 0 ? 1 : kind == 1 ? 2 + below(9) : 4 * (1 + below(4));
  std::vector<double> c;
  for (int i = 0; i < planes; ++i)
    c.push_back(360.0 * (i + (i == 0 || kind != 1 ? 0 : random.uniform() / 2)) / planes);
  std::vector<double> values(c.size() * gamma.size());
  for (double& value : values) {
    const double bits = random.uniform();
    value = below(8) == 0 ? 0 : bits * (below(2) == 0 ? 1e-7 : 3.7e5);
  }
  values[0] = 1;  // none is dark
  const auto row = [&](int plane) {
    return values.begin() + plane * static_cast<std::ptrdiff_t>(gamma.size());
  };
  const auto copy = [&](int from, int to) {
    std::copy(row(from), row(from) + static_cast<std::ptrdiff_t>(gamma.size()), row(to));
  };
  if (kind == 2 || kind == 4)
    for (int i = 1; i < planes / 2; ++i) copy(i, planes - i);
  if (kind == 3 || kind == 4)
    for (int i = 0; i <= planes / 2; ++i) copy((planes / 2 - i + planes) % planes, i);
  if (kind == 4)
    for (int i = 1; i < planes / 2; ++i) copy(i, planes - i);
  if (kind == 3)
    for (int i = planes / 2 + 1; i < planes; ++i) copy(i, (planes / 2 + planes - i) % planes);
  return {LightQuantity::luminous, gamma, c, values};
}

}  // namespace catoptric::test

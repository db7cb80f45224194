#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::fuzz {

/// What a mutator draws from: the same seed, the same file.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}

  /// 0 ... count - 1; 0 for a count of 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : engine_() % count; }
  bool one_in(std::size_t count) { return below(count) == 0; }

  template <typename Item>
  const Item& of(const std::vector<Item>& items) {
    return items[below(items.size())];
  }

 private:
  std::mt19937_64 engine_;
};

/// Numbers that readers have stumbled over, as text.
inline const std::vector<std::string>& hostile_numbers() {
  static const std::vector<std::string> list{"0",
                                             "-0",
                                             "1",
                                             "-1",
                                             "2",
                                             "3",
                                             "0.",
                                             "-0.",
                                             "1.",
                                             "-1.",
                                             "0.5",
                                             "1.E308",
                                             "-1.E308",
                                             "1.7976931348623157E308",
                                             "1.E-308",
                                             "4.9E-324",
                                             "1.E999",
                                             "-1.E999",
                                             "1.E-999",
                                             "1.D400",
                                             "NAN",
                                             "INF",
                                             "-INF",
                                             "2147483647",
                                             "-2147483648",
                                             "2147483648",
                                             "4294967295",
                                             "4294967296",
                                             "65535",
                                             "65536",
                                             "1000000",
                                             "100000000",
                                             "-5",
                                             "9223372036854775807",
                                             "-9223372036854775808",
                                             "18446744073709551616",
                                             "99999999999999999999999999",
                                             "1.E12",
                                             "1.E-12",
                                             "1.E-7",
                                             "1E",
                                             "1.5.5",
                                             "--1",
                                             "+",
                                             ".",
                                             "",
                                             "1e5",
                                             "0x10",
                                             "1,0",
                                             "1 0",
                                             "$",
                                             "*"};
  return list;
}

/// Bytes changed, lost, doubled, put in; the file cut off; without a thought for what they mean.
inline void mutate_bytes(std::string& text, Chance& chance) {
  if (text.empty()) return;
  const std::size_t at = chance.below(text.size());
  switch (chance.below(9)) {
    case 0:
      text[at] = static_cast<char>(chance.below(256));
      break;
    case 1:
      text[at] = "0123456789,.;#*()$' X\r\n"[chance.below(23)];
      break;
    case 2:
      text.erase(at, 1 + chance.below(60));
      break;
    case 3:
      text.insert(at, text.substr(chance.below(text.size()), 1 + chance.below(200)));
      break;
    case 4:
      text.insert(at, 1, static_cast<char>(chance.below(256)));
      break;
    case 5:
      text.insert(at, chance.of(hostile_numbers()));
      break;
    case 6:
      if (chance.one_in(4)) text.resize(at);
      break;
    case 7:
      if (chance.one_in(8)) text.insert(at, 1 + chance.below(5000), "(,'#0 A"[chance.below(7)]);
      break;
    default:
      text[at] = static_cast<char>(text[at] ^ (1 << chance.below(8)));
      break;
  }
}

}  // namespace catoptric::fuzz

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include "cad/detail/exchange_file.h"

namespace catoptric::cad::detail {
namespace {

void check_text(std::string_view what, std::string_view text) {
  for (const char c : text)
    if (c < ' ' || c > '~')
      throw InputError({fmt::format("the {} \"{}\" cannot go into an exchange file", what, text), "",
                        "IGES and STEP labels are printable ASCII",
                        "write it without accents or control characters"});
  if (text.size() > 200)
    throw InputError({fmt::format("the {} is {} characters long", what, text.size()), "", "200 are allowed",
                      "shorten it"});
}

/// Whether the text is a date and time like 2026-01-31T12:00:00.
bool is_time_stamp(std::string_view text) {
  constexpr std::string_view form = "dddd-dd-ddTdd:dd:dd";
  if (text.size() != form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (form[i] == 'd' ? !digit : text[i] != form[i]) return false;
  }
  const auto number = [&](std::size_t from) { return (text[from] - '0') * 10 + text[from + 1] - '0'; };
  return number(5) >= 1 && number(5) <= 12 && number(8) >= 1 && number(8) <= 31 && number(11) < 24 &&
         number(14) < 60 && number(17) < 60;
}

/// The time of the environment's SOURCE_DATE_EPOCH (seconds since 1970, reproducible-builds.org), else 1970.
std::string default_time_stamp() {
  std::time_t seconds = 0;
  if (const char* said = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string_view digits(said);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
    constexpr std::time_t last_of_year_9999 = 253402300799;
    if (error != std::errc() || end != digits.data() + digits.size() || seconds < 0 ||
        seconds > last_of_year_9999)
      throw InputError({fmt::format("SOURCE_DATE_EPOCH is \"{}\"", said), "the environment",
                        "it holds seconds since 1970", "unset it"});
  }
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(seconds));
}

}  // namespace

FileLabels make_labels(const std::filesystem::path& path, const ExportOptions& options) {
  check_text("product name", options.product);
  check_text("author", options.author);
  check_text("organization", options.organization);
  check_text("material", options.material.name);
  if (!options.time_stamp.empty() && !is_time_stamp(options.time_stamp))
    throw InputError({fmt::format("\"{}\" is no time stamp", options.time_stamp), "", "",
                      "write it like 2026-01-31T12:00:00"});
  std::string name = path.filename().string();
  for (char& c : name)
    if (c < ' ' || c > '~') c = '_';
  return {name,
          options.product,
          options.author,
          options.organization,
          options.time_stamp.empty() ? default_time_stamp() : options.time_stamp,
          options.material};
}

const char* unit_name(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return "MM";
    case LengthUnit::centimetre:
      return "CM";
    case LengthUnit::metre:
      return "M";
    case LengthUnit::inch:
      return "INCH";
  }
  return "MM";
}

}  // namespace catoptric::cad::detail

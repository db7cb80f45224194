#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "photometry/lm63.h"

namespace catoptric::photometry {

/// What stands before the numbers of an IES file.
struct Lm63Header {
  Lm63Version version = Lm63Version::of_1986;
  std::vector<Lm63Keyword> keywords;
  std::string tilt;           ///< what follows TILT=
  std::string_view rest;      ///< the text behind that line
  std::size_t rest_line = 0;  ///< number of its first line
};

/// @fails InputError for an edition that is not known, or without a TILT= line
Lm63Header read_lm63_header(std::string_view text, const std::string& name, std::vector<std::string>& notes);

}  // namespace catoptric::photometry

#pragma once

#include <string>
#include <vector>

#include "fuzz/support/chance.h"

namespace catoptric::fuzz {

/// Changes a STEP file where a reader must think: numbers, references, counts of lists, types, entities.
class StepMutator {
 public:
  /// @in text a valid ISO 10303-21 file
  explicit StepMutator(const std::string& text);

  std::string mutated(Chance& chance) const;

 private:
  std::vector<std::string> tokens_;
  std::vector<std::string> keywords_, references_;
  std::vector<std::size_t> numbers_, reference_places_, keyword_places_, statement_ends_;
};

}  // namespace catoptric::fuzz

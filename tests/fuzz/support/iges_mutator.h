#pragma once

#include <array>
#include <string>
#include <vector>

#include "fuzz/support/chance.h"

namespace catoptric::fuzz {

/// Changes an IGES file where a reader must think: parameters, counts, pointers, types, directory fields,
/// sections. The columns are laid out anew, so that a change is met where it is meant.
class IgesMutator {
 public:
  /// @in text a valid IGES file of fixed columns
  explicit IgesMutator(const std::string& text);

  std::string mutated(Chance& chance) const;

 private:
  /// An entity: its twenty directory fields of eight columns, and its parameters as tokens.
  struct Entity {
    std::array<std::string, 20> fields;
    std::vector<std::string> parameters;
  };
  static void mutate(Entity& entity, std::size_t entities, Chance& chance);
  std::string laid_out(const std::vector<Entity>& entities, const std::string& global, Chance& chance) const;

  std::string start_, global_;
  std::vector<Entity> entities_;
};

}  // namespace catoptric::fuzz

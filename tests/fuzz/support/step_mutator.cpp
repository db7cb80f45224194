#include "fuzz/support/step_mutator.h"

#include <algorithm>
#include <cctype>

namespace catoptric::fuzz {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; }
bool starts_number(char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '+'; }

/// The token of `text` that begins at `at`: a string, a reference, a number, a word, or one character.
std::size_t token_length(const std::string& text, std::size_t at) {
  const auto while_true = [&](std::size_t from, auto&& holds) {
    while (from < text.size() && holds(text[from])) ++from;
    return from - at;
  };
  const char c = text[at];
  if (c == '\'') {
    const std::size_t end = text.find('\'', at + 1);
    return end == std::string::npos ? text.size() - at : end + 1 - at;
  }
  if (c == '#') return while_true(at + 1, [](char d) { return std::isdigit(static_cast<unsigned char>(d)); });
  if (starts_number(c)) return while_true(at + 1, [](char d) { return is_word(d) || d == '.' || d == '+'; });
  if (is_word(c)) return while_true(at + 1, is_word);
  return 1;
}

/// Entities that a file may name though no seed has them.
const std::vector<std::string>& other_entities() {
  static const std::vector<std::string> list{"CIRCLE",
                                             "ELLIPSE",
                                             "HYPERBOLA",
                                             "PARABOLA",
                                             "LINE",
                                             "POLYLINE",
                                             "TRIMMED_CURVE",
                                             "COMPOSITE_CURVE",
                                             "BEZIER_CURVE",
                                             "OFFSET_CURVE_3D",
                                             "PLANE",
                                             "CYLINDRICAL_SURFACE",
                                             "CONICAL_SURFACE",
                                             "SPHERICAL_SURFACE",
                                             "TOROIDAL_SURFACE",
                                             "OFFSET_SURFACE",
                                             "EDGE_CURVE",
                                             "EDGE_LOOP",
                                             "VERTEX_LOOP",
                                             "GEOMETRIC_CURVE_SET",
                                             "ADVANCED_FACE",
                                             "CLOSED_SHELL",
                                             "MANIFOLD_SOLID_BREP",
                                             "MAPPED_ITEM",
                                             "DEGENERATE_TOROIDAL_SURFACE",
                                             "QUASI_UNIFORM_CURVE",
                                             "UNIFORM_CURVE",
                                             "SURFACE_CURVE",
                                             "SEAM_CURVE",
                                             "AXIS2_PLACEMENT_3D",
                                             "CARTESIAN_POINT",
                                             "DIRECTION",
                                             "VECTOR",
                                             "VERTEX_POINT",
                                             "UNKNOWN_ENTITY"};
  return list;
}

}  // namespace

StepMutator::StepMutator(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    tokens_.push_back(text.substr(at, token_length(text, at)));
    at += tokens_.back().size();
  }
  keywords_ = other_entities();
  for (std::size_t i = 0; i < tokens_.size(); ++i) {
    const std::string& token = tokens_[i];
    if (token[0] == '#' && token.size() > 1) {
      reference_places_.push_back(i);
      references_.push_back(token);
    } else if (starts_number(token[0])) {
      numbers_.push_back(i);
    } else if (std::isupper(static_cast<unsigned char>(token[0])) && token.size() > 1) {
      keyword_places_.push_back(i);
      keywords_.push_back(token);
    } else if (token == ";") {
      statement_ends_.push_back(i);
    }
  }
}

std::string StepMutator::mutated(Chance& chance) const {
  std::vector<std::string> tokens = tokens_;
  for (std::size_t rounds = 1 + chance.below(4); rounds > 0; --rounds) switch (chance.below(12)) {
      case 0:
      case 1:
        tokens[chance.of(numbers_)] = chance.of(hostile_numbers());
        break;
      case 2:
      case 3:
        tokens[chance.of(reference_places_)] = chance.of(references_);
        break;
      case 4:
        tokens[chance.of(reference_places_)] =
            chance.one_in(2) ? "#" + chance.of(hostile_numbers()) : std::string("$");
        break;
      case 5:
        tokens[chance.of(keyword_places_)] = chance.of(keywords_);
        break;
      case 6:  // a list gets shorter, or an argument is lost
        tokens[chance.below(tokens.size())].clear();
        break;
      case 7: {  // a list gets longer
        const std::size_t at = chance.of(numbers_);
        const std::size_t times = chance.one_in(10) ? 1 + chance.below(2000) : 1 + chance.below(3);
        std::string more = tokens[at];
        for (std::size_t i = 0; i < times; ++i) more += "," + tokens[at];
        tokens[at] = std::move(more);
        break;
      }
      case 8: {  // an entity is lost, or there twice
        const std::size_t which = chance.below(statement_ends_.size() - 1);
        const std::size_t begin = statement_ends_[which] + 1, end = statement_ends_[which + 1];
        std::string copy;
        for (std::size_t i = begin; i <= end; ++i) {
          copy += tokens[i];
          tokens[i].clear();
        }
        if (chance.one_in(2)) tokens[end] = copy + copy;
        break;
      }
      case 9:
        std::swap(tokens[chance.below(tokens.size())], tokens[chance.below(tokens.size())]);
        break;
      case 10:
        tokens[chance.below(tokens.size())] = chance.one_in(20) ? std::string(1 + chance.below(3000), '(')
                                                                : std::string(1, "(),;'*$."[chance.below(8)]);
        break;
      default:
        tokens[chance.of(numbers_)] = tokens[chance.of(numbers_)];
        break;
    }
  std::string text;
  for (const std::string& token : tokens) text += token;
  if (chance.one_in(5))
    for (std::size_t rounds = 1 + chance.below(4); rounds > 0; --rounds) mutate_bytes(text, chance);
  return text;
}

}  // namespace catoptric::fuzz

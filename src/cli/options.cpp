#include <fmt/format.h>

#include "cli/commands.h"

namespace catoptric::cli {

std::vector<design::Override> CommonOptions::overrides() const {
  std::vector<design::Override> changes;
  for (const std::string& text : set) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError({fmt::format("--set {} has no value", text), "command line", "it is key=value",
                        "--set model.photons=1000000"});
    changes.push_back({text.substr(0, equals), text.substr(equals + 1), "--set"});
  }
  if (seed) changes.push_back({"seed", fmt::format("{}", *seed), "--seed"});
  if (threads) changes.push_back({"threads", fmt::format("{}", *threads), "--threads"});
  return changes;
}

std::filesystem::path CommonOptions::out_folder() const {
  return out.empty() ? std::filesystem::path("out") / input.stem() : out;
}

}  // namespace catoptric::cli

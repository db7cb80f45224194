#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/ranks.h"
#include "design/settings.h"

namespace catoptric::cli {

/// What all commands share, as given on the command line.
struct CommonOptions {
  std::filesystem::path input;  ///< scene, study or profile file
  std::vector<std::string> set;
  std::filesystem::path out;  ///< empty: out/<name of the input>
  std::optional<int> threads;
  std::optional<std::int64_t> seed;
  bool quiet = false;
  bool json = false;       ///< JSON lines instead of words
  Ranks* ranks = nullptr;  ///< that share the run; set before any command

  /// Rank 0 writes and speaks, the others neither.
  bool leads() const { return !ranks || ranks->leads(); }
  bool tells_people() const { return !quiet && !json && leads(); }
  bool tells_programs() const { return json && leads(); }
  /// --set, --seed and --threads as overrides of the scene.  @fails UsageError for a --set without "="
  std::vector<design::Override> overrides() const;
  std::filesystem::path out_folder() const;
};

struct DesignOptions {
  bool resume = false;  ///< go on with the search that was broken off in the output folder
};

struct LandscapeOptions {
  std::vector<std::filesystem::path>
      paths;  ///< convergence.csv files whose searches are drawn over the contours
};

struct ProfileOptions {
  std::optional<std::size_t> index;
  std::vector<double> axis;  ///< empty, or a point in mm and a direction
  std::string unit = "mm";
};

struct ExportCommandOptions {
  std::vector<std::string> formats;  ///< of export_format_names; empty: step and iges
};

/// What --format takes, in the order in which files are written.
std::vector<std::string> export_format_names();

struct CompletionOptions {
  std::string shell;  ///< bash, zsh, fish
};

struct ManualOptions {
  bool scene = false;  ///< the page of scene files
};

ExitCode design_command(const CommonOptions& options, const DesignOptions& more);
ExitCode simulate_command(const CommonOptions& options);
ExitCode landscape_command(const CommonOptions& options, const LandscapeOptions& more);
ExitCode explain_command(const CommonOptions& options);
ExitCode tradeoff_command(const CommonOptions& options);
ExitCode sensitivity_command(const CommonOptions& options);
ExitCode intensity_command(const CommonOptions& options);
ExitCode rays_command(const CommonOptions& options);
ExitCode study_command(const CommonOptions& options);
ExitCode profile_command(const CommonOptions& options, const ProfileOptions& more);
ExitCode export_command(const CommonOptions& options, const ExportCommandOptions& more);
ExitCode completion_command(const CompletionOptions& options);
ExitCode manual_command(const ManualOptions& options);

}  // namespace catoptric::cli

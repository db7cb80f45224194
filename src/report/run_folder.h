#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/profile.h"
#include "cad/export.h"
#include "report/page_parts.h"
#include "report/run_figures.h"
#include "report/run_files.h"
#include "report/table.h"

namespace catoptric::report {

/// Writes one run's folder and remembers what it wrote. Each file is written whole or not at all.
class RunFolder {
 public:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  void text(const std::string& name, const std::string& content);
  void table(const std::string& name, const Table& content);
  /// A file that `write` makes whole or not at all.
  void made(const std::string& name, const std::function<void(const std::filesystem::path&)>& write);
  void note(std::string sentence) { written_.notes.push_back(std::move(sentence)); }
  /// @fails CadError when the file lost something
  void exchange(const std::string& name, const Profile& profile, const cad::ExportOptions& options);
  /// Draws into the subfolder `figures`; a figure that cannot be drawn is a note.
  std::vector<DrawnFigure> draw_all(const std::vector<NamedFigure>& figures);
  WrittenFiles take() { return std::move(written_); }

 private:
  std::filesystem::path path_;
  WrittenFiles written_;
};

}  // namespace catoptric::report

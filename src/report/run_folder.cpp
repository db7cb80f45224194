#include "report/run_folder.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "report/csv.h"
#include "report/gnuplot.h"

namespace catoptric::report {

void RunFolder::text(const std::string& name, const std::string& content) {
  write_file_whole(path_ / name, content);
  written_.names.push_back(name);
}

void RunFolder::table(const std::string& name, const Table& content) {
  write_csv(path_ / name, content, UnitsInHeader::no);
  written_.names.push_back(name);
}

void RunFolder::exchange(const std::string& name, const Profile& profile, const cad::ExportOptions& options) {
  cad::export_reflector(profile, path_ / name, options);
  written_.names.push_back(name);
}

std::vector<DrawnFigure> RunFolder::draw_all(const std::vector<NamedFigure>& figures) {
  const std::filesystem::path folder = path_ / "figures";
  prepare_output_folder(folder);
  std::vector<DrawnFigure> drawn;
  for (const NamedFigure& figure : figures) {
    Drawing drawing = draw(figure.script, folder, figure.name);
    if (!drawing.drawn() && (written_.notes.empty() || written_.notes.back() != drawing.sentence))
      written_.notes.push_back(drawing.sentence);
    drawn.push_back({figure.name, figure.caption, std::move(drawing.svg_text)});
  }
  written_.names.push_back(fmt::format("figures/ ({} plots)", drawn.size()));
  return drawn;
}

}  // namespace catoptric::report

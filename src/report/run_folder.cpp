#include "report/run_folder.h"

#include <fmt/format.h>

#include <future>

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

void RunFolder::made(const std::string& name,
                     const std::function<void(const std::filesystem::path&)>& write) {
  write(path_ / name);
  written_.names.push_back(name);
}

void RunFolder::exchange(const std::string& name, const Profile& profile, const cad::ExportOptions& options) {
  cad::export_reflector(profile, path_ / name, options);
  written_.names.push_back(name);
}

std::vector<DrawnFigure> RunFolder::draw_all(const std::vector<NamedFigure>& figures) {
  const std::filesystem::path folder = path_ / "figures";
  prepare_output_folder(folder, 0);
  // One gnuplot a figure, all at once: they spend half of their time starting.
  std::vector<std::future<Drawing>> drawings;
  for (const NamedFigure& figure : figures)
    drawings.push_back(std::async(std::launch::async,
                                  [&figure, &folder] { return draw(figure.script, folder, figure.name); }));
  std::vector<DrawnFigure> drawn;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const NamedFigure& figure = figures[i];
    Drawing drawing = drawings[i].get();
    if (!drawing.drawn() && (written_.notes.empty() || written_.notes.back() != drawing.sentence))
      written_.notes.push_back(drawing.sentence);
    drawn.push_back({figure.name, figure.caption, std::move(drawing.svg_text)});
  }
  written_.names.push_back(fmt::format("figures/ ({} plots)", drawn.size()));
  return drawn;
}

}  // namespace catoptric::report

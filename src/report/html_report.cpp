#include "report/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include <kainjow/mustache.hpp>

#include "report/page_template.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

using kainjow::mustache::data;
using kainjow::mustache::mustache;

data list() { return data(data::type::list); }

data facts_data(const std::vector<Fact>& facts) {
  data all = list();
  for (const auto& [name, value] : facts) {
    data fact;
    fact.set("name", clean_line(name));
    fact.set("value", clean_line(value));
    all << fact;
  }
  return all;
}

data table_data(const PageTable& shown) {
  const Table& table = shown.table;
  require_rectangular(table);
  std::vector<bool> number;
  data columns = list(), rows = list();
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    number.push_back(holds_numbers(table, i));
    data column;
    column.set("heading", clean_line(heading(table.columns[i])));
    column.set("number", static_cast<bool>(number[i]));
    columns << column;
  }
  for (const auto& row : table.rows) {
    data cells = list();
    for (std::size_t i = 0; i < row.size(); ++i) {
      data cell;
      cell.set("text", readable(row[i], table.columns[i].digits));
      cell.set("number", static_cast<bool>(number[i]));
      cells << cell;
    }
    data line;
    line.set("cells", cells);
    rows << line;
  }
  data result;
  result.set("has_caption", !shown.caption.empty());
  result.set("caption", clean_line(shown.caption));
  result.set("columns", columns);
  result.set("rows", rows);
  return result;
}

/// An SVG document as a part of a page: without its XML declaration, and with its identifiers, all of which
/// gnuplot gives to every picture alike, made its own.
std::string embedded(std::string_view document, std::size_t number) {
  constexpr std::array<std::string_view, 5> names{" id=\"", " id='", "href=\"#", "href='#", "url(#"};
  const std::size_t begin = document.find("<svg");
  if (begin == std::string_view::npos) return {};
  document.remove_prefix(begin);
  const std::string prefix = fmt::format("figure{}-", number);
  std::string svg;
  svg.reserve(document.size() + 4096);
  bool inside_tag = false;
  for (std::size_t i = 0; i < document.size();) {
    if (document[i] == '<') inside_tag = true;
    if (document[i] == '>') inside_tag = false;
    const auto found = std::find_if(names.begin(), names.end(), [&](std::string_view name) {
      return inside_tag && document.substr(i, name.size()) == name;
    });
    if (found != names.end()) {
      svg += std::string(*found) + prefix;
      i += found->size();
    } else {
      svg += document[i++];
    }
  }
  return svg;
}

data figure_data(const PageFigure& figure, std::size_t number) {
  const std::string svg = embedded(figure.svg, number);
  data result;
  result.set("drawn", !svg.empty());
  result.set("svg", svg);
  result.set("missing", clean_line(figure.missing));
  result.set("caption", clean_line(figure.caption));
  return result;
}

data section_data(const PageSection& section, std::size_t& figure_number) {
  data paragraphs = list(), tables = list(), figures = list();
  for (const std::string& paragraph : section.paragraphs) {
    data text;
    text.set("text", clean_line(paragraph));
    paragraphs << text;
  }
  for (const PageTable& table : section.tables) tables << table_data(table);
  for (const PageFigure& figure : section.figures) figures << figure_data(figure, ++figure_number);
  data result;
  result.set("heading", clean_line(section.heading));
  result.set("paragraphs", paragraphs);
  result.set("has_facts", !section.facts.empty());
  result.set("facts", facts_data(section.facts));
  result.set("tables", tables);
  result.set("figures", figures);
  return result;
}

}  // namespace

std::string html_page(const Page& page) {
  std::size_t figure_number = 0;
  data sections = list();
  for (const PageSection& section : page.sections) sections << section_data(section, figure_number);
  data everything;
  everything.set("title", clean_line(page.title));
  everything.set("has_subtitle", !page.subtitle.empty());
  everything.set("subtitle", clean_line(page.subtitle));
  everything.set("has_facts", !page.facts.empty());
  everything.set("facts", facts_data(page.facts));
  everything.set("sections", sections);
  everything.set("has_footer", !page.footer.empty());
  everything.set("footer", clean_line(page.footer));
  mustache form(page_template);
  if (!form.is_valid()) throw std::logic_error("page template: " + form.error_message());
  return form.render(everything);
}

}  // namespace catoptric::report

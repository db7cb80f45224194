#include "report/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include <kainjow/mustache.hpp>

#include "base/light_units.h"
#include "report/page_template.h"
#include "report/text.h"
#include "report/three_js.h"
#include "report/view_script.h"

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
    column.set("heading", printed(clean_line(heading(table.columns[i]))));
    column.set("number", static_cast<bool>(number[i]));
    columns << column;
  }
  for (const auto& row : table.rows) {
    data cells = list();
    for (std::size_t i = 0; i < row.size(); ++i) {
      data cell;
      const std::string text = readable(row[i], table.columns[i].digits);
      cell.set("text", table.columns[i].name == "unit" ? printed(text) : text);
      cell.set("number", static_cast<bool>(number[i]));
      cells << cell;
    }
    data line;
    line.set("cells", cells);
    rows << line;
  }
  data result;
  result.set("is_folded", !shown.folded.empty());
  result.set("folded", clean_line(shown.folded));
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

/// A relative address that cannot be taken for one of another place.
/// @from  RFC 3986: all but unreserved characters and "/" by their bytes
std::string relative_address(std::string_view path) {
  std::string address = "./";
  for (const char c : path) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    address += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return address;
}

data links_data(const std::vector<Fact>& links) {
  data all = list();
  for (const auto& [words, path] : links) {
    data link;
    link.set("words", clean_line(words));
    link.set("address", relative_address(path));
    all << link;
  }
  return all;
}

data listing_data(const PageListing& listing) {
  std::string text;
  for (std::size_t begin = 0; begin < listing.text.size();) {
    const std::size_t end = std::min(listing.text.find('\n', begin), listing.text.size());
    text += clean_line(std::string_view(listing.text).substr(begin, end - begin)) + "\n";
    begin = end + 1;
  }
  data result;
  result.set("caption", clean_line(listing.caption));
  result.set("text", text);
  return result;
}

data section_data(const PageSection& section, std::size_t number, std::size_t& figure_number) {
  data paragraphs = list(), tables = list(), figures = list();
  for (const std::string& paragraph : section.paragraphs) {
    data text;
    text.set("text", clean_line(paragraph));
    paragraphs << text;
  }
  for (const PageTable& table : section.tables) tables << table_data(table);
  for (const PageFigure& figure : section.figures) figures << figure_data(figure, ++figure_number);
  data listings = list();
  for (const PageListing& listing : section.listings) listings << listing_data(listing);
  data result;
  result.set("place", fmt::format("part{}", number));
  result.set("heading", clean_line(section.heading));
  result.set("has_view", section.view.has_value());
  if (section.view) result.set("view_caption", clean_line(section.view->caption));
  result.set("has_links", !section.links.empty());
  result.set("links", links_data(section.links));
  result.set("listings", listings);
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
  const View3d* view = nullptr;
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    sections << section_data(page.sections[i], i + 1, figure_number);
    if (page.sections[i].view) view = &*page.sections[i].view;
  }
  data everything;
  everything.set("has_origin", !page.origin.empty());
  everything.set("origin", clean_line(page.origin));
  everything.set("has_contents", page.sections.size() > 2);
  everything.set("has_view", view != nullptr);
  if (view) {
    everything.set("view_data", view_json(*view));
    everything.set("view_script", inside_script(view_script));
    everything.set("three_js", inside_script(three_js()));
    everything.set("orbit_controls_js", inside_script(orbit_controls_js()));
    everything.set("three_js_licence", std::string(three_js_licence()));
  }
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

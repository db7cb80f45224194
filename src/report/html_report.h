#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/table.h"

namespace catoptric::report {

/// A name with its value, both as a person reads them.
using Fact = std::pair<std::string, std::string>;

struct PageTable {
  std::string caption;  ///< may be empty
  Table table;
};

/// A picture inside the page.
struct PageFigure {
  std::string caption;
  std::string svg;      ///< an SVG document as draw() gives it; empty when there is none
  std::string missing;  ///< what stands in its place then
};

/// One part of a page, shown in this order; empty lists are left out.
struct PageSection {
  std::string heading;
  std::vector<std::string> paragraphs;
  std::vector<Fact> facts;
  std::vector<PageTable> tables;
  std::vector<PageFigure> figures;
};

struct Page {
  std::string title;
  std::string subtitle;
  std::vector<Fact> facts;  ///< the answer, before everything else
  std::vector<PageSection> sections;
  std::string footer;  ///< version, seed, command
};

/// The page as one self-contained HTML file: nothing is loaded from anywhere (a content security policy says
/// so), light and dark by the reader's setting, fit to print. All text is escaped; pictures are embedded with
/// their own names, so that several stand side by side.
/// @fails InputError when a table is not rectangular
std::string html_page(const Page& page);

}  // namespace catoptric::report

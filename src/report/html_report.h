#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/table.h"
#include "report/view_3d.h"

namespace catoptric::report {

/// A name with its value, both as a person reads them.
using Fact = std::pair<std::string, std::string>;

struct PageTable {
  std::string caption;  ///< may be empty
  Table table;
  std::string folded = {};  ///< the words that unfold a long table; empty: it lies open
};

/// A file's text as it is, line by line.
struct PageListing {
  std::string caption, text;
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
  std::vector<Fact> links = {};  ///< words, and the page they lead to, relative to this one
  std::vector<PageListing> listings = {};
  std::optional<View3d> view = {};
};

struct Page {
  std::string title;
  std::string subtitle;     ///< the verdict, in a sentence or two
  std::vector<Fact> facts;  ///< the answer, before everything else
  std::vector<PageSection> sections;
  std::string footer;       ///< version, seed, command
  std::string origin = {};  ///< which command made it of which scene, above the title
};

/// The page as one self-contained HTML file: nothing is loaded from anywhere (a content security policy says
/// so), light and dark by the reader's setting, fit to print. All text is escaped; pictures are embedded with
/// their own names, so that several stand side by side. Only a page with a view in space has a script: the
/// library that draws it.
/// @fails InputError when a table is not rectangular
std::string html_page(const Page& page);

}  // namespace catoptric::report

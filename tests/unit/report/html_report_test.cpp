#include "report/html_report.h"

#include <catch2/catch.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "base/errors.h"

using namespace catoptric;
using namespace catoptric::report;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

const std::string picture =
    "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 8 6\"><defs><circle id='gpDot' r='1'/></defs>"
    "<g id=\"plot\"><use xlink:href='#gpDot'/><text style=\"filter:url(#box)\">my id='x' "
    "url(#y)</text></g></svg>";

Page page() {
  Page result{"Parabola", "start A", {{"RMSE", "0.004 W/m²"}}, {}, "catoptric 0.1"};
  PageSection section{"Result", {"First.", "Second."}, {{"rim", "10 cm"}}, {}, {}};
  section.tables.push_back(
      {"Control points", {{{"name", ""}, {"r", "cm", 4}}, {{"P0", 0.0}, {"P1", 3.14159265}}}});
  section.figures.push_back({"Generatrix", picture, ""});
  section.figures.push_back({"Irradiance", picture, ""});
  section.figures.push_back({"Landscape", "", "gnuplot is not installed"});
  result.sections.push_back(section);
  return result;
}

}  // namespace

TEST_CASE("a page holds all it was given, once and in order") {
  const std::string html = html_page(page());
  std::size_t at = 0;
  for (const char* part : {"<!DOCTYPE html>",
                           "<title>Parabola</title>",
                           "<h1>Parabola</h1>",
                           "start A",
                           "<dt>RMSE</dt><dd>0.004 W/m²</dd>",
                           "<h2>Result</h2>",
                           "<p>First.</p>",
                           "<p>Second.</p>",
                           "<dt>rim</dt><dd>10 cm</dd>",
                           "Control points",
                           "<th scope=\"col\">name</th>",
                           "<th scope=\"col\" class=\"n\">r [cm]</th>",
                           "<td>P1</td>",
                           "<td class=\"n\">3.142</td>",
                           "<figcaption>Generatrix</figcaption>",
                           "<figcaption>Irradiance</figcaption>",
                           "gnuplot is not installed",
                           "<figcaption>Landscape</figcaption>",
                           "<footer>catoptric 0.1</footer>",
                           "</html>"}) {
    INFO(part);
    const auto next = html.find(part, at);
    REQUIRE(next != std::string::npos);
    at = next + 1;
  }
  CHECK(count(html, "<svg") == 2);
  CHECK(count(html, "<?xml") == 0);
}

TEST_CASE("pictures side by side share no identifier, and their words stay as they are") {
  const std::string html = html_page(page());
  CHECK(count(html, "id='figure1-gpDot'") == 1);
  CHECK(count(html, "id='figure2-gpDot'") == 1);
  CHECK(count(html, "xlink:href='#figure2-gpDot'") == 1);
  CHECK(count(html, "url(#figure1-box)") == 1);
  CHECK(count(html, ">my id='x' url(#y)</text>") == 2);
}

TEST_CASE("user text is escaped everywhere, and braces are no template") {
  const std::string evil = "<script>alert(\"x\")</script> & 'y' {{title}} {{{svg}}} {{#sections}} \xff\n\x1b";
  Page hostile{evil, evil, {{evil, evil}}, {}, evil};
  PageSection section{evil, {evil}, {{evil, evil}}, {}, {}};
  section.tables.push_back({evil, {{{evil, evil}}, {{evil}}}});
  section.figures.push_back({evil, "", evil});
  section.figures.push_back({evil, picture, ""});
  hostile.sections.push_back(section);
  const std::string html = html_page(hostile);
  CHECK(count(html, "<script") == 0);
  CHECK(count(html, "&lt;script&gt;alert(&quot;x&quot;)") >= 12);
  CHECK(count(html, "{{title}} {{{svg}}} {{#sections}}") >= 12);
  CHECK(html.find('\x1b') == std::string::npos);
  CHECK(html.find('\xff') == std::string::npos);
}

TEST_CASE("a listing keeps its lines and is only text, and a link leads to no other place") {
  PageSection section{"h", {}, {}, {}, {}};
  section.listings.push_back({"scene.toml", "title = \"</pre><script>\"\n[source]\n"});
  section.links = {{"Run a", "javascript:alert(1)/report.html"}, {"Run b", "b & \"c\"/report.html"}};
  Page with{"t", "", {}, {section}, ""};
  const std::string html = html_page(with);
  CHECK(count(html, "<pre>title = &quot;&lt;/pre&gt;&lt;script&gt;&quot;\n[source]\n</pre>") == 1);
  CHECK(count(html, "href=\"./javascript%3Aalert%281%29/report.html\"") == 1);
  CHECK(count(html, "href=\"./b%20%26%20%22c%22/report.html\"") == 1);
}

TEST_CASE("a view in space brings its library, and text in its data ends no script") {
  Page with = page();
  with.sections[0].view = View3d{};
  with.sections[0].view->generatrix = {{0, 10}, {10, 5}};
  with.sections[0].view->sources = {{"</script><!--<script>", {0, 0, 5}, {0, 0, 1}, {1, 0, 0}}};
  with.sections[0].view->caption = "The <mirror>";
  const std::string html = html_page(with);
  CHECK(count(html, "script-src 'nonce-catoptric'") == 1);
  CHECK(count(html, "<script") == 4);  // data, library, mouse, view
  CHECK(count(html, "</script") == 4);
  CHECK(count(html, "\"mirror\":[[0.0,10.0],[10.0,5.0]]") == 1);
  CHECK(count(html, "OrbitControls = function") == 1);
  CHECK(count(html, "Permission is hereby granted, free of charge") == 1);
  CHECK(count(html, "<figcaption>The &lt;mirror&gt;</figcaption>") == 1);
  CHECK(count(html_page(page()), "<script") == 0);
}

TEST_CASE("a long table can be folded, and a page of many parts has contents") {
  Page with = page();
  with.sections[0].tables[0].folded = "All 2 rows";
  with.sections.push_back({"Second", {"p"}, {}, {}, {}});
  with.sections.push_back({"Third", {"p"}, {}, {}, {}});
  const std::string html = html_page(with);
  CHECK(count(html, "<details><summary>All 2 rows</summary>") == 1);
  CHECK(count(html, "<a href=\"#part2\">Second</a>") == 1);
  CHECK(count(html, "<section id=\"part2\">") == 1);
  CHECK(count(html_page(page()), "<nav") == 0);
}

TEST_CASE("a page asks for nothing from anywhere") {
  const std::string html = html_page(page());
  CHECK(count(html, "default-src 'none'") == 1);
  for (const char* outside : {"http://", "https://", "src=", "<link", "@import"})
    CHECK(count(html, outside) == 0);
}

TEST_CASE("an empty page and empty sections leave no empty frames") {
  const std::string html = html_page({"t", "", {}, {{"h", {}, {}, {}, {}}}, ""});
  for (const char* frame : {"<dl", "<table", "<figure", "<footer", "<p"}) CHECK(count(html, frame) == 0);
}

TEST_CASE("tags are closed in the order they were opened") {
  const std::string html = html_page(page());
  const std::set<std::string> single = {"meta", "br", "hr"};
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z][a-z0-9]*)([^>]*)>");
  for (std::sregex_iterator it(html.begin() + 15, html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2], rest = (*it)[3];
    if (single.count(name) || (!rest.empty() && rest.back() == '/')) continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
      continue;
    }
    REQUIRE_FALSE(open.empty());
    CHECK(open.back() == name);
    open.pop_back();
  }
  CHECK(open.empty());
}

TEST_CASE("a table that is not rectangular is refused") {
  Page wrong = page();
  wrong.sections[0].tables[0].table.rows[0].pop_back();
  CHECK_THROWS_AS(html_page(wrong), InputError);
}

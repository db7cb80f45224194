#include "report/table.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "base/random_stream.h"
#include "report/csv.h"
#include "report/text.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::report;

TEST_CASE("csv numbers read back as the same doubles") {
  Table table{{{"value", "W/m2"}}, {}};
  std::vector<double> written{0.1, 1.0 / 3, 5e-324, std::numeric_limits<double>::max(), -0.0, 1e22};
  RandomStream stream(7, Purpose::test, 0);
  for (int i = 0; i < 1000; ++i) written.push_back(std::ldexp(stream.uniform() - 0.5, i - 500));
  for (double value : written) table.rows.push_back({value});
  std::istringstream lines(csv_text(table, UnitsInHeader::no));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "value");
  for (double value : written) {
    REQUIRE(std::getline(lines, line));
    const double read = std::stod(line == "5e-324" ? "0x1p-1074" : line);
    CHECK(read == value);
    CHECK(std::signbit(read) == std::signbit(value));
  }
}

TEST_CASE("csv keeps units in the header only when asked, and quotes what needs it") {
  const Table table{{{"x", "cm"}, {"a,b", ""}}, {{1.5, "say \"hi\"\nthere"}, {2LL, std::monostate{}}}};
  CHECK(csv_text(table, UnitsInHeader::yes) == "x [cm],\"a,b\"\n1.5,\"say \"\"hi\"\"\nthere\"\n2,\n");
  CHECK(csv_text(table, UnitsInHeader::no).substr(0, 8) == "x,\"a,b\"\n");
}

TEST_CASE("csv spells out what is not finite") {
  const double infinity = std::numeric_limits<double>::infinity();
  const Table table{{{"x", ""}}, {{infinity}, {-infinity}, {std::nan("")}}};
  CHECK(csv_text(table, UnitsInHeader::no) == "x\ninf\n-inf\nnan\n");
}

TEST_CASE("a row of the wrong length is refused by name") {
  const Table table{{{"x", ""}, {"y", ""}}, {{1.0, 2.0}, {1.0}}};
  CHECK_THROWS_WITH(csv_text(table, UnitsInHeader::no), Catch::Contains("row 2"));
  CHECK_THROWS_AS(text_table(table), InputError);
}

TEST_CASE("csv files are written whole") {
  const test::TemporaryFolder folder;
  write_csv(folder / "a.csv", {{{"x", ""}}, {{1.0}}}, UnitsInHeader::no);
  CHECK(test::read_whole(folder / "a.csv") == "x\n1\n");
  CHECK_THROWS_AS(write_csv(folder / "none/a.csv", {}, UnitsInHeader::no), IoError);
}

TEST_CASE("columns of the terminal table line up, umlauts and superscripts included") {
  const Table table{{{"run", ""}, {"E", "W/m²", 3}, {"n", ""}},
                    {{"start A", 1.23456, 12LL}, {"größer", 0.5, 1234LL}, {"-", std::monostate{}, 7LL}}};
  CHECK(text_table(table) ==
        "run      E [W/m²]     n\n"
        "-------  --------  ----\n"
        "start A      1.23    12\n"
        "größer        0.5  1234\n"
        "-               -     7\n");
}

TEST_CASE("user text cannot break lines or encodings") {
  CHECK(clean_line("a\nb\tc\x7f") == "a b c ");
  CHECK(clean_line("\x1b[31mred") == " [31mred");
  CHECK(clean_line("gr\xfc\xdf") == "gr\xEF\xBF\xBD\xEF\xBF\xBD");          // Latin-1
  CHECK(clean_line("\xC0\xAF") == "\xEF\xBF\xBD\xEF\xBF\xBD");              // overlong
  CHECK(clean_line("\xED\xA0\x80").find('\xED') == std::string::npos);      // surrogate
  CHECK(clean_line("\xF4\x90\x80\x80").find('\xF4') == std::string::npos);  // beyond Unicode
  CHECK(clean_line("a\xE2\x82") == "a\xEF\xBF\xBD\xEF\xBF\xBD");            // cut short
  CHECK(clean_line("\xC2\x85x") == " x");                                   // next line, C1
  CHECK(clean_line("W/m² € 𝛼") == "W/m² € 𝛼");
  CHECK(width_of("W/m²") == 4);
}

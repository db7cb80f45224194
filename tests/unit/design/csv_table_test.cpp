#include "design/csv_table.h"

#include <catch2/catch.hpp>

#include "base/errors.h"

using namespace catoptric;
using namespace catoptric::design;

TEST_CASE("a table is read with units in its headings, comments and a byte order mark") {
  const CsvTable table = parse_csv_table(
      "\xEF\xBB\xBF# from a spreadsheet\nx [cm], y(cm),\"irradiance\"\r\n1,2,3.5\r\n\n-1e-3, 0 ,7\n",
      "t.csv");
  CHECK(table.names == std::vector<std::string>{"x", "y", "irradiance"});
  CHECK(column(table, "irradiance", "t.csv") == std::vector<double>{3.5, 7});
  CHECK(table.columns[0] == std::vector<double>{1, -1e-3});
  CHECK(table.lines == std::vector<std::size_t>{3, 5});
}

TEST_CASE("a bad table is refused with file, line and column") {
  const auto refused = [](const char* text, const char* part) {
    INFO(text);
    CHECK_THROWS_WITH(parse_csv_table(text, "t.csv"), Catch::Contains(part));
  };
  refused("", "no rows");
  refused("x,y\n", "no rows");
  refused("x,y\n1,2\n3\n", "t.csv:3");
  refused("x,y\n1,two\n", "t.csv:2, column y");
  refused("x,y\n1,nan\n", "no finite number");
  refused("x,y\n1,1e999\n", "no finite number");
  refused("x,y\n1,2 3\n", "no finite number");
  refused("x;y\n1;2\n", "no finite number");
  CHECK_THROWS_WITH(column(parse_csv_table("x,y\n1,2", "t.csv"), "z", "t.csv"),
                    Catch::Contains("its columns are x, y"));
}

#include "report/page_tables.h"

#include <catch2/catch.hpp>

using namespace catoptric::report;

TEST_CASE("a value keeps the digits that its noise leaves it") {
  CHECK(rounded_to_noise(0.003350123, 0.000030456) == 0.00335);
  CHECK(rounded_to_noise(711.6712345, 0.05) == 711.671);
  CHECK(rounded_to_noise(123456.789, 1200) == 123500);
  CHECK(rounded_to_noise(-2.5, 30) == -2);  // to whole numbers, for 30 has two digits
  CHECK(rounded_to_noise(0.123456789, 0) == 0.123456789);
}

TEST_CASE("a value and its noise end at the same place") {
  CHECK(measured_text(0.003350123, 0.000030456) == "0.003350 ± 0.000030");
  CHECK(measured_text(711.6712, 0.05) == "711.671 ± 0.050");
  CHECK(measured_text(123456.789, 1200) == "1.235e+05 ± 1.2e+03");
  CHECK(measured_text(1.63923456, 0) == "1.639");
}

TEST_CASE("a long table keeps its first and last rows and says that there are more") {
  Table table{{{"i", ""}, {"x", ""}}, {}};
  for (long long i = 0; i < 1000; ++i) table.rows.push_back({i, 0.5});
  const Table few = shortened(table);
  CHECK(few.rows.size() == 61);
  CHECK(std::get<long long>(few.rows[9][0]) == 9);
  CHECK(std::get<std::string>(few.rows[10][0]) == "…");
  CHECK(std::get<long long>(few.rows[11][0]) == 950);
  CHECK(std::get<long long>(few.rows.back()[0]) == 999);
  require_rectangular(few);
  table.rows.resize(60);
  CHECK(shortened(table).rows.size() == 60);
}

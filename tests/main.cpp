#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <iostream>

#include "base/float_traps.h"
#include "support/statistics.h"

int main(int argc, char** argv) {
  catoptric::trap_float_errors();
  const int failed = Catch::Session().run(argc, argv);
  if (catoptric::test::checks_made <= catoptric::test::checks_of_a_room) return failed;
  std::cerr << catoptric::test::checks_made << " statistical checks: more than the level of each allows for; "
            << "raise checks_of_a_room in support/statistics.h\n";
  return 1;
}

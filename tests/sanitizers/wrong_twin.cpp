// Makes one mistake on purpose, so that a build which is to notice it can prove that it does.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <limits>
#include <string_view>
#include <vector>

#include "base/float_traps.h"
#include "sim/side_by_side.h"

namespace {

constexpr std::size_t pieces = 100;

std::vector<double> numbers(pieces, 1.0);  // and so known to no compiler

/// So long that a second thread comes to take a part.
void dwell() { usleep(1000); }

/// The pieces add to one sum.
double race() {
  double sum = 0;
  catoptric::sim::side_by_side(pieces, [&](std::size_t i) {
    dwell();
    sum += numbers[i];
  });
  return sum;
}

/// The pieces write what was made before and is read afterwards, each its own: no mistake.
double no_race() {
  std::vector<double> slots(pieces);
  catoptric::sim::side_by_side(pieces, [&](std::size_t i) {
    dwell();
    slots[i] = numbers[i];
  });
  double sum = 0;
  for (double each : slots) sum += each;
  return sum;
}

double out_of_bounds() { return *(numbers.data() + numbers.size()); }

double vector_bounds() { return numbers[numbers.size()]; }

double signed_overflow() { return std::numeric_limits<int>::max() + static_cast<int>(numbers[0]); }

double division() { return numbers[0] / (numbers[1] - 1); }

double ordered_nan() { return numbers[0] * std::numeric_limits<double>::quiet_NaN() < numbers[1] ? 1 : 0; }

/// No mistake where it is allowed.
double untrapped_division() {
  const catoptric::UntrappedFloats untrapped;
  return division();
}

extern "C" void say_stopped(int signal) {
  const std::string_view text = signal == SIGFPE ? "trapped\n" : "aborted\n";
  _exit(write(STDOUT_FILENO, text.data(), text.size()) > 0 ? 0 : 1);
}

struct Twin {
  std::string_view name;
  double (*run)();
};

constexpr Twin twins[] = {{"race", race},
                          {"no_race", no_race},
                          {"out_of_bounds", out_of_bounds},
                          {"vector_bounds", vector_bounds},
                          {"signed_overflow", signed_overflow},
                          {"division", division},
                          {"ordered_nan", ordered_nan},
                          {"untrapped_division", untrapped_division}};

}  // namespace

int main(int count, char** arguments) {
  std::signal(SIGFPE, say_stopped);
  std::signal(SIGABRT, say_stopped);
  catoptric::trap_float_errors();
  for (const Twin& twin : twins)
    if (count == 2 && twin.name == arguments[1])
      return std::printf("unnoticed: %g\n", twin.run()) > 0 ? 0 : 1;
  return 2;
}

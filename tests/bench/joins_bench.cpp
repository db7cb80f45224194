// What sharing itself costs: mpirun -n N build-bench/bench_joins. Median and quartiles of a join, by ranks
// and by the size of what a task gives. No light is computed.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "cluster/open_ranks.h"

namespace {

using namespace catoptric;
using Clock = std::chrono::steady_clock;

/// Microseconds of so many calls, sorted.
std::vector<double> times_us(int calls, const std::function<void()>& call) {
  std::vector<double> times;
  for (int i = 0; i < calls; ++i) {
    const auto begin = Clock::now();
    call();
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  return times;
}

void print(const Ranks& ranks, const char* what, std::size_t bytes, const std::vector<double>& us) {
  if (ranks.leads())
    fmt::print("{} ranks  {:<44} {:>9} B  {:>10.1f} us ({:.1f} to {:.1f})\n", ranks.size(), what, bytes,
               us[us.size() / 2], us[us.size() / 4], us[3 * us.size() / 4]);
}

}  // namespace

int main() {
  const auto ranks = cluster::open_ranks();
  const std::size_t count = static_cast<std::size_t>(ranks->size());
  for (const std::size_t size :
       {std::size_t{8}, std::size_t{16'384}, std::size_t{1'048'576}, std::size_t{16'777'216}}) {
    const Bytes result(size, 'x');
    const int calls = size > 1'000'000 ? 21 : 301;
    print(*ranks, "told by rank 0 to all", size,
          times_us(calls, [&] { ranks->from_first([&] { return result; }); }));
    print(*ranks, "a task for each rank, results told to all", size,
          times_us(calls, [&] { ranks->share(count, [&](std::size_t) { return result; }); }));
    print(*ranks, "64 tasks, summed by rank 0", size, times_us(calls / 3, [&] {
      std::size_t sum = 0;
      ranks->join(
          64, [&](std::size_t) { return result; },
          [&](std::size_t, const Bytes& each) { sum += each.size(); }, [] { return Bytes(); });
    }));
    print(*ranks, "of each rank to all", size,
          times_us(calls, [&] { ranks->each([&](std::size_t, std::size_t) { return result; }); }));
  }
  return ranks->leave(0, "");
}

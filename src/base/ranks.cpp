#include "base/ranks.h"

#include "base/byte_record.h"

namespace catoptric {

Bytes Ranks::join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) {
  for (std::size_t task = 0; task < count; ++task) take(task, compute(task));
  return joined();
}

std::vector<Bytes> Ranks::share(std::size_t count, const Compute& compute) {
  std::vector<Bytes> results;
  const Bytes all = join(
      count, compute, [&](std::size_t, Bytes result) { results.push_back(std::move(result)); },
      [&] { return ByteWriter().put(results).take(); });
  return ByteReader(all).get<std::vector<Bytes>>();
}

std::vector<Bytes> Ranks::each(const ComputeOwn& compute) {
  return {from_first([&] { return compute(0, 1); })};
}

Bytes Ranks::from_first(const std::function<Bytes()>& compute) {
  Bytes only;
  return join(
      1, [&](std::size_t) { return compute(); }, [&](std::size_t, Bytes result) { only = std::move(result); },
      [&] { return std::move(only); });
}

Ranks& lone_process() {
  static Ranks ranks;
  return ranks;
}

}  // namespace catoptric

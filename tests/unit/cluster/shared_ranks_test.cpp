#include "cluster/shared_ranks.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "support/mailboxes.h"

using namespace catoptric;
using namespace catoptric::cluster;

namespace {

/// What each of so many ranks, a thread each, makes of the same work.
std::vector<std::string> on_ranks(int size, const std::function<std::string(SharedRanks&)>& work) {
  test::Mailboxes mailboxes(size);
  std::vector<std::string> results(static_cast<std::size_t>(size));
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      SharedRanks ranks(mailboxes.of(rank));
      try {
        results[static_cast<std::size_t>(rank)] = work(ranks);
        ranks.leave(0, "");
      } catch (const Error& error) {
        results[static_cast<std::size_t>(rank)] = error.what();
        ranks.leave(static_cast<int>(error.exit_code()), error.what());
      }
    });
  threads.clear();
  return results;
}

std::string joined(const std::vector<Bytes>& list) {
  std::string all;
  for (const Bytes& each : list) all += each + " ";
  return all;
}

std::string square(std::size_t i) { return std::to_string(i * i); }

}  // namespace

TEST_CASE("every rank gets every result in the order of the tasks and each task is computed once") {
  for (const int size : {1, 2, 3, 5}) {
    std::vector<std::atomic<int>> computed(40);
    const auto results = on_ranks(size, [&](SharedRanks& ranks) {
      std::string all;
      for (const std::size_t count : {std::size_t{40}, std::size_t{0}, std::size_t{1}, std::size_t{2}})
        all += joined(ranks.share(count,
                                  [&](std::size_t i) {
                                    ++computed[i];
                                    return square(i);
                                  })) +
               "| ";
      return all;
    });
    std::string expected;
    for (std::size_t i = 0; i < 40; ++i) expected += square(i) + " ";
    expected += "| | 0 | 0 1 | ";
    for (const std::string& each : results) CHECK(each == expected);
    CHECK(computed[0] == 3);
    CHECK(computed[1] == 2);
    for (std::size_t i = 2; i < 40; ++i) CHECK(computed[i] == 1);
  }
}

TEST_CASE("a single task is rank 0's and its result goes to all") {
  for (const std::string& each : on_ranks(3, [](SharedRanks& ranks) {
         return ranks.from_first([&] { return "of " + std::to_string(ranks.rank()); });
       }))
    CHECK(each == "of 0");
}

TEST_CASE("tasks are handed out as ranks come free so that a slow rank gets fewer") {
  std::vector<std::atomic<int>> tasks(3);
  on_ranks(3, [&](SharedRanks& ranks) {
    ranks.share(60, [&](std::size_t) {
      ++tasks[static_cast<std::size_t>(ranks.rank())];
      std::this_thread::sleep_for(std::chrono::milliseconds(ranks.rank() == 1 ? 40 : 1));
      return Bytes();
    });
    return Bytes();
  });
  CHECK(tasks[0] + tasks[1] + tasks[2] == 60);
  CHECK(tasks[1] < 15);
}

TEST_CASE("the error of the first task that failed ends the work on every rank alike") {
  for (const int size : {1, 2, 3}) {
    const auto results = on_ranks(size, [&](SharedRanks& ranks) {
      ranks.share(20, [&](std::size_t i) -> Bytes {
        if (i == 7 || i == 12) throw InputError({"task " + std::to_string(i), "here", "", ""});
        return square(i);
      });
      return Bytes("not reached");
    });
    for (const std::string& each : results) CHECK(each == "here: task 7");
  }
}

TEST_CASE("after a task failed the next work is shared as before") {
  const auto results = on_ranks(3, [&](SharedRanks& ranks) {
    try {
      ranks.share(9, [](std::size_t i) -> Bytes {
        if (i == 2) throw Interrupted();
        return {};
      });
    } catch (const Interrupted&) {
    }
    return joined(ranks.share(4, square));
  });
  for (const std::string& each : results) CHECK(each == "0 1 4 9 ");
}

TEST_CASE("an error of rank 0 while it takes results reaches all") {
  const auto results = on_ranks(3, [&](SharedRanks& ranks) {
    return ranks.join(
        10, square,
        [](std::size_t i, const Bytes&) {
          if (i == 3) throw IoError({"the disk is full", "", "", ""});
        },
        [] { return Bytes("done"); });
  });
  for (const std::string& each : results) CHECK(each == "the disk is full");
}

TEST_CASE("inside a task all tasks are the rank's own") {
  const auto results = on_ranks(2, [&](SharedRanks& ranks) {
    return joined(ranks.share(6, [&](std::size_t i) {
      const int outside = ranks.rank();
      return joined(ranks.share(3, [&](std::size_t j) {
        return ranks.rank() == outside ? std::to_string(10 * i + j) : Bytes("another rank");
      }));
    }));
  });
  for (const std::string& each : results) {
    CHECK(each.starts_with("0 1 2  10 11 12 "));
    CHECK(each.find("another") == std::string::npos);
  }
}

TEST_CASE("what each rank keeps is asked of it and told to all in the order of the ranks") {
  for (const int size : {1, 2, 3, 5}) {
    const auto results = on_ranks(size, [&](SharedRanks& ranks) {
      std::string kept;
      const auto first = joined(ranks.each([&](std::size_t rank, std::size_t count) {
        kept = std::to_string(rank) + "/" + std::to_string(count);
        std::this_thread::sleep_for(std::chrono::milliseconds(rank == 1 ? 20 : 0));
        return kept;
      }));
      return first + joined(ranks.each([&](std::size_t, std::size_t) { return kept; })) +
             joined(ranks.share(3, square));
    });
    std::string all;
    for (int rank = 0; rank < size; ++rank) all += std::to_string(rank) + "/" + std::to_string(size) + " ";
    for (const std::string& each : results) CHECK(each == all + all + "0 1 4 ");
  }
}

TEST_CASE("inside a task a rank is the only one") {
  const auto results = on_ranks(2, [&](SharedRanks& ranks) {
    return joined(ranks.share(4, [&](std::size_t) {
      return joined(ranks.each([](std::size_t rank, std::size_t count) {
        return std::to_string(rank) + "/" + std::to_string(count);
      }));
    }));
  });
  for (const std::string& each : results) CHECK(each == "0/1  0/1  0/1  0/1  ");
}

TEST_CASE("an error of any rank about what it keeps is an error of all") {
  for (const int bad : {0, 2}) {
    const auto results = on_ranks(3, [&](SharedRanks& ranks) -> Bytes {
      try {
        ranks.each([&](std::size_t rank, std::size_t) -> Bytes {
          if (static_cast<int>(rank) == bad) throw CadError({"rank " + std::to_string(rank), "", "", ""});
          return {};
        });
      } catch (const CadError& error) {
        return error.what() + joined(ranks.share(2, square));
      }
      return "no error";
    });
    for (const std::string& each : results) CHECK(each == "rank " + std::to_string(bad) + "0 1 ");
  }
}

TEST_CASE("ranks that wait for a rank 0 that has failed are let go") {
  const auto results = on_ranks(3, [&](SharedRanks& ranks) -> Bytes {
    if (ranks.leads()) throw IoError({"no folder", "", "", ""});
    return ranks.rank() == 1 ? ranks.from_first([] { return Bytes(); }) : joined(ranks.share(5, square));
  });
  CHECK(results[0] == "no folder");
  CHECK(results[1].find("interrupted") != std::string::npos);
  CHECK(results[2].find("interrupted") != std::string::npos);
}

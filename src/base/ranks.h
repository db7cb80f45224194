#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace catoptric {

/// What processes send each other (see byte_record.h).
using Bytes = std::string;

/// The processes that do one run together. All run the same code on the same input and come to the same calls
/// in the same order; work that is cut into tasks is then shared among them. This class is a process by
/// itself; cluster/shared_ranks.h has one of several.
class Ranks {
 public:
  /// The result of a task, which must not depend on who computes it.
  using Compute = std::function<Bytes(std::size_t task)>;
  /// Takes the results in the order of the tasks' numbers.
  using Take = std::function<void(std::size_t task, Bytes result)>;
  /// What came of all results taken.
  using Joined = std::function<Bytes()>;

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// How many of them share this machine's memory.
  virtual int size_here() const { return 1; }
  /// Whether nobody else asks for what is computed, now: it need not be made bytes.
  virtual bool is_alone() const { return true; }
  /// Rank 0, which alone writes, prints and asks the user's signals.
  bool leads() const { return rank() == 0; }

  /// Computes tasks 0 .. count - 1, each once on whatever rank comes free; rank 0 takes the results as soon
  /// as their turn comes, and what it made of them goes to every rank. A single task is always computed by
  /// rank 0. Inside a task all tasks are this rank's own.
  /// @out   joined() of rank 0, the same bytes for any number of ranks
  /// @fails on every rank alike with the error of the first task that failed, or of take or joined
  virtual Bytes join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined);

  /// All results, on every rank.
  std::vector<Bytes> share(std::size_t count, const Compute& compute);

  /// What each rank computes about what it keeps in its own memory; the ranks that do so are numbered.
  using ComputeOwn = std::function<Bytes(std::size_t rank, std::size_t ranks)>;

  /// Each rank computes once, and all get all results, by rank. Inside a task a rank is the only one.
  /// @fails on every rank alike with the error of the first rank that failed
  virtual std::vector<Bytes> each(const ComputeOwn& compute);

  /// What rank 0 computes, on every rank.
  Bytes from_first(const std::function<Bytes()>& compute);
};

/// A process without others.
Ranks& lone_process();

}  // namespace catoptric

#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "cluster/messenger.h"

namespace catoptric::cluster {

/// Several processes that share the tasks of one run. Rank 0 hands out task after task as ranks come free,
/// from a thread of its own while it computes too; results come back to it, and what it joins goes to all.
class SharedRanks : public Ranks {
 public:
  explicit SharedRanks(std::unique_ptr<Messenger> messenger);
  ~SharedRanks() override;

  int rank() const override;
  int size() const override;
  int size_here() const override;
  bool is_alone() const override { return inside_ || size() == 1; }

  /// @in    take and joined ask no joins themselves
  /// @fails as Ranks::join; Interrupted where rank 0 has ended with an error. Ends all processes, with a
  ///        message, where a rank has ended early (with its exit code) or the ranks came to different calls
  Bytes join(std::size_t count, const Compute& compute, const Take& take, const Joined& joined) override;

  /// @fails as join
  std::vector<Bytes> each(const ComputeOwn& compute) override;

  /// To be called once at the end of every rank: waits until all have come here, so that none is killed while
  /// it still writes. Once rank 0 has failed, others may take 5 s to end the task they are at.
  /// @in    words: of the error that ended this rank, if one did
  /// @out   what the process is to exit with. Rank 0: its own exit code, or where that is 0 the one of the
  ///        first rank that failed, whose words are printed; others: 0
  int leave(int exit_code, const std::string& words);

 private:
  class Leader;
  Message wait();
  Message from_leader();
  void end_if_farewell(const Message& message);
  void require_here(int from, std::uint64_t join);
  void tell_all(const Bytes& joined);
  Bytes follow(std::size_t count, const Compute& compute);
  Bytes lead(std::size_t count, const Compute& compute, const Take& take, const Joined& joined);
  std::vector<Bytes> gather(Bytes own);
  int release_all(int exit_code);
  [[noreturn]] void end_all(int exit_code, const std::string& words);

  std::unique_ptr<Messenger> messenger_;
  std::uint64_t joins_ = 0;  ///< so far: the same on all ranks
  bool inside_ = false;      ///< of a task
  bool released_ = false;    ///< rank 0 has ended
};

}  // namespace catoptric::cluster

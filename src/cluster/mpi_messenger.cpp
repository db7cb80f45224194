#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "cluster/mpi_module.h"

namespace catoptric::cluster {
namespace {

/// Messages through MPI's C interface. Errors of MPI end all processes, which is what it does unless told
/// otherwise.
/// @from MPI: A Message-Passing Interface Standard 3.1, chapters 3 (point-to-point), 6.4.2 (who shares
/// memory) and 12.4 (threads)
class MpiMessenger : public Messenger {
 public:
  MpiMessenger() {
    int given = MPI_THREAD_SINGLE;
    // Rank 0 answers from one thread while another computes; never two at a time.
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given);
    if (given < MPI_THREAD_SERIALIZED) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm here;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &size_here_);
    MPI_Comm_free(&here);
  }
  MpiMessenger(const MpiMessenger&) = delete;
  MpiMessenger& operator=(const MpiMessenger&) = delete;
  ~MpiMessenger() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int size_here() const override { return size_here_; }

  /// The length first, then pieces, since MPI counts in int.
  void send(int to, Topic topic, const Bytes& bytes) override {
    const std::uint64_t length = bytes.size();
    MPI_Send(&length, sizeof length, MPI_BYTE, to, static_cast<int>(topic), MPI_COMM_WORLD);
    for (std::uint64_t at = 0; at < length; at += piece)
      MPI_Send(bytes.data() + at, static_cast<int>(std::min(piece, length - at)), MPI_BYTE, to,
               static_cast<int>(topic), MPI_COMM_WORLD);
  }

  std::optional<Message> look() override {
    int there = 0;
    MPI_Message handle;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &handle, &status);
    if (!there) return std::nullopt;
    std::uint64_t length = 0;
    MPI_Mrecv(&length, sizeof length, MPI_BYTE, &handle, MPI_STATUS_IGNORE);
    Message message{status.MPI_SOURCE, static_cast<Topic>(status.MPI_TAG), Bytes(length, '\0')};
    for (std::uint64_t at = 0; at < length; at += piece)
      MPI_Recv(message.bytes.data() + at, static_cast<int>(std::min(piece, length - at)), MPI_BYTE,
               message.from, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

  void abort(int exit_code) override { MPI_Abort(MPI_COMM_WORLD, exit_code); }

 private:
  static constexpr std::uint64_t piece = std::uint64_t{1} << 30;
  int rank_ = 0, size_ = 1, size_here_ = 1;
};

}  // namespace
}  // namespace catoptric::cluster

extern "C" catoptric::cluster::Messenger* catoptric_open_mpi_2() {
  return new catoptric::cluster::MpiMessenger;
}

#pragma once

#include <optional>

#include "base/ranks.h"

namespace catoptric::cluster {

/// What a message is about.
enum class Topic : int {
  request,     ///< of a task, with the result of the one before
  assignment,  ///< of a task, or that there are no more
  joined,      ///< what came of all tasks
  farewell,    ///< a rank has come to its end
  release,     ///< all have: they may go
};
inline constexpr int topics = 5;

struct Message {
  int from;
  Topic topic;
  Bytes bytes;
};

/// Messages between the processes of one run. From one process to another they arrive in the order in which
/// they were sent. For one thread at a time.
class Messenger {
 public:
  virtual ~Messenger() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Processes of the run on this machine, this one counted.
  virtual int size_here() const = 0;
  /// May wait until the other process looks for messages.
  virtual void send(int to, Topic topic, const Bytes& bytes) = 0;
  /// A message that has arrived, if any.
  virtual std::optional<Message> look() = 0;
  /// Ends all processes at once.
  virtual void abort(int exit_code) = 0;
};

}  // namespace catoptric::cluster

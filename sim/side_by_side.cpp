#include "sim/side_by_side.h"

#include <tbb/parallel_for.h>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace catoptric::sim {
namespace {

/// What TBB's library guarantees and the thread sanitizer cannot see in it, for that is not instrumented: all
/// that came before the loop happens before each piece of it, and each piece before all that comes after.
/// Nothing is said about one piece and another, so that races between them are still found.
class KnownOrder {
 public:
#ifdef __SANITIZE_THREAD__
  KnownOrder() { __tsan_release(&start_); }
  ~KnownOrder() { __tsan_acquire(&end_); }

  class Piece {
   public:
    explicit Piece(KnownOrder& order) : end_(order.end_) { __tsan_acquire(&order.start_); }
    ~Piece() { __tsan_release(&end_); }

   private:
    char& end_;
  };

 private:
  char start_ = 0, end_ = 0;

 public:
  /// Tasks look at it once more after their last piece. The library knows when; told nothing, the sanitizer
  /// would take what comes next to this place on the stack for a race, so it is left where it is for ever.
  tbb::task_group_context& context = *new tbb::task_group_context;
#else
  tbb::task_group_context context;

  KnownOrder() {}
  struct Piece {
    explicit Piece(KnownOrder&) {}
  };
#endif
};

}  // namespace

void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work) {
  KnownOrder order;
  tbb::parallel_for(
      std::size_t{0}, count,
      [&](std::size_t i) {
        const KnownOrder::Piece piece(order);
        work(i);
      },
      order.context);
}

}  // namespace catoptric::sim

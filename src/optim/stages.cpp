#include "optim/stages.h"

#include <utility>

namespace catoptric::optim {

void append(Outcome& all, Outcome stage) {
  for (Iterate& each : stage.history) {
    each.k += all.successes;
    each.iteration += all.iterations;
    each.evaluations += all.evaluations;
    all.history.push_back(std::move(each));
  }
  all.successes += stage.successes;
  all.iterations += stage.iterations;
  all.evaluations += stage.evaluations;
  all.cache_hits += stage.cache_hits;
  all.restarts += stage.restarts;
  all.ending = stage.ending;
  all.sentence = std::move(stage.sentence);
  all.best = std::move(stage.best);
  all.value = stage.value;
}

}  // namespace catoptric::optim

#pragma once

#include <cstddef>
#include <functional>

namespace catoptric::sim {

/// work(0) to work(count - 1), on as many threads as are free, in any order. It alone starts threads in this
/// room.
/// @fails what work throws; some of the work is then not done
void side_by_side(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace catoptric::sim

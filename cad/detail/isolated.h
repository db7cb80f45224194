#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace catoptric::cad::detail {

/// Runs `work` in a child process and hands back the bytes it returns; CadErrors come through as they are.
/// OCCT's readers trust a file's pointers: of STEP files with a few wrong characters a third kill the process
/// (measured on 800), and some keep it busy for ever. A child's death is a message, ours would be a loss.
/// @in    where: the file, for messages; `work` must not use other threads
/// @fails CadError when the child dies, sends nothing or takes longer than `limit`
/// @cost  about 2 ms
std::string run_isolated(std::string_view where, std::chrono::seconds limit,
                         const std::function<std::string()>& work);

}  // namespace catoptric::cad::detail

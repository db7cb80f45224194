#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace catoptric::cad::detail {

/// What a child may use before it is ended.
struct IsolationLimits {
  std::chrono::milliseconds time;  ///< by the clock; of the processor in whole seconds
  std::size_t memory_bytes;        ///< beyond what the program has when it starts the child
};

/// Limits for reading a file, unless the caller has a time of his own: OCCT reads about a MiB in a second,
/// and a file that takes far more would go on for ever.
/// @in    bytes_of_a_byte: memory that a byte of the file may take, beside `least_bytes`
IsolationLimits limits_for_file(const std::filesystem::path& file,
                                std::optional<std::chrono::milliseconds> time_limit, std::size_t least_bytes,
                                std::size_t bytes_of_a_byte);

/// Runs `work` in a child process and hands back the bytes it returns; CadErrors come through as they are.
/// OCCT's readers trust a file's pointers: of STEP files with a few wrong characters a third kill the process
/// (measured on 800), and some keep it busy for ever. A child's death is a message, ours would be a loss.
/// The child has no files open but its pipe, writes nothing to the terminal and leaves no core; no process
/// and no file descriptor outlives the call.
/// @in    where: the file, for messages; `work` must not use other threads
/// @fails CadError when the child dies, sends nothing or too much, or takes longer than the limit
/// @cost  about 2 ms
std::string run_isolated(std::string_view where, const IsolationLimits& limits,
                         const std::function<std::string()>& work);

}  // namespace catoptric::cad::detail

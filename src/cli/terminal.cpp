#include "cli/terminal.h"

#include <fmt/color.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>

namespace catoptric::cli {
namespace {

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value && *value;
}

fmt::text_style style(Ink ink) {
  switch (ink) {
    case Ink::error:
      return fmt::emphasis::bold | fmt::fg(fmt::terminal_color::red);
    case Ink::good:
      return fmt::fg(fmt::terminal_color::green);
    case Ink::warning:
      return fmt::fg(fmt::terminal_color::yellow);
    case Ink::strong:
      break;
  }
  return fmt::emphasis::bold;
}

}  // namespace

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

bool is_coloured(std::FILE* stream) {
  const char* terminal = std::getenv("TERM");
  const bool dumb = !terminal || std::string_view(terminal) == "dumb";
  return !is_set("NO_COLOR") && !dumb && is_terminal(stream);
}

std::size_t terminal_columns() {
  winsize size{};
  constexpr std::size_t usual = 80;
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

std::string inked(std::string_view text, Ink ink, std::FILE* stream) {
  return is_coloured(stream) ? fmt::format(style(ink), "{}", text) : std::string(text);
}

}  // namespace catoptric::cli

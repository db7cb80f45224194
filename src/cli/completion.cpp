#include "cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "design/keys.h"

namespace catoptric::cli {
namespace {

/// Keys of scenes that have no names of the user's in them.
std::vector<std::string> fixed_keys() {
  std::vector<std::string> keys;
  for (const design::Key& key : design::scene_keys())
    if (key.path.find('*') == std::string_view::npos) keys.emplace_back(key.path);
  return keys;
}

std::vector<std::string> names_of(const std::vector<OptionWords>& options) {
  std::vector<std::string> names;
  for (const OptionWords& option : options)
    if (option.name.starts_with("-")) names.push_back(option.name);
  return names;
}

/// Ends of the names of files that an argument may be.
std::vector<std::string> endings_of(const OptionWords& argument) {
  if (argument.name == "FILE") return {"igs", "iges", "step", "stp"};
  if (argument.name.ends_with(".toml")) return {"toml"};
  return {};
}

std::string escaped(std::string_view text, std::string_view special) {
  std::string out;
  for (const char letter : text) {
    if (special.find(letter) != std::string_view::npos) out += '\\';
    out += letter;
  }
  return out;
}

/// In single quotes.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char letter : text) out += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return out + "'";
}

std::string bash_case(const CommandWords& command) {
  std::vector<std::string> endings, choices;
  for (const OptionWords& option : command.options)
    if (!option.name.starts_with("-")) {
      endings = endings_of(option);
      choices = option.choices;
    }
  return fmt::format("    {}) options={} endings={} words={} ;;\n", command.name,
                     in_quotes(fmt::format("{}", fmt::join(names_of(command.options), " "))),
                     in_quotes(fmt::format("{}", fmt::join(endings, "|"))),
                     in_quotes(fmt::format("{}", fmt::join(choices, " "))));
}

std::string zsh_option(const OptionWords& option) {
  const std::string meaning = escaped(option.meaning, "[]:\\");
  if (!option.name.starts_with("-")) {
    const std::vector<std::string> endings = endings_of(option);
    const std::string what = !option.choices.empty() ? fmt::format("({})", fmt::join(option.choices, " "))
                             : endings.empty()       ? std::string()
                                               : fmt::format("_files -g \"*.({})\"", fmt::join(endings, "|"));
    return in_quotes(fmt::format("1:{}:{}", escaped(option.name, ":"), what));
  }
  if (option.value.empty()) return in_quotes(fmt::format("{}[{}]", option.name, meaning));
  const std::string what = option.name == "--set"    ? "_catoptric_keys"
                           : option.name == "--out"  ? "_files -/"
                           : !option.choices.empty() ? fmt::format("({})", fmt::join(option.choices, " "))
                           : option.value == "FILE"  ? "_files"
                                                     : "";
  return in_quotes(fmt::format("*{}[{}]:{}:{}", option.name, meaning, escaped(option.value, ":"), what));
}

}  // namespace

std::string bash_completion(const ProgramWords& program) {
  std::vector<std::string> first = names_of(program.options);
  std::string cases;
  std::vector<std::string> choices;
  for (const CommandWords& command : program.commands) {
    first.push_back(command.name);
    cases += bash_case(command);
    for (const OptionWords& option : command.options)
      if (option.name.starts_with("--") && !option.choices.empty())
        choices.push_back(fmt::format("    {}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n",
                                      option.name, fmt::join(option.choices, " ")));
  }
  return fmt::format(
      R"bash(# bash completion of catoptric; made by "catoptric completion bash"
_catoptric() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD - 1]}}" options= endings= words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{}' -- "$current"))
    return
  fi
  case $before in
    --set)
      compopt -o nospace
      COMPREPLY=($(compgen -S = -W '{}' -- "$current"))
      return
      ;;
    --out)
      compopt -o filenames
      COMPREPLY=($(compgen -d -- "$current"))
      return
      ;;
{}  esac
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $current in
    -*) COMPREPLY=($(compgen -W "$options" -- "$current")) ;;
    *)
      if [ -n "$words" ]; then
        COMPREPLY=($(compgen -W "$words" -- "$current"))
        return
      fi
      compopt -o filenames
      shopt -q extglob || local reset=1
      shopt -s extglob
      COMPREPLY=($(compgen -f -X "!*.@($endings)" -- "$current") $(compgen -d -- "$current"))
      [ -z "$reset" ] || shopt -u extglob
      ;;
  esac
}}
complete -F _catoptric catoptric
)bash",
      fmt::join(first, " "), fmt::join(fixed_keys(), " "), fmt::join(choices, ""), cases);
}

std::string zsh_completion(const ProgramWords& program) {
  std::string commands, cases;
  for (const CommandWords& command : program.commands) {
    commands += fmt::format("    {}\n", in_quotes(command.name + ":" + escaped(command.meaning, ":\\")));
    std::vector<std::string> options;
    for (const OptionWords& option : command.options) options.push_back(zsh_option(option));
    cases += fmt::format("    {}) _arguments {} ;;\n", command.name, fmt::join(options, " "));
  }
  return fmt::format(
      R"zsh(#compdef catoptric
# zsh completion of catoptric; made by "catoptric completion zsh"
_catoptric_keys() {{
  local -a keys
  keys=({})
  compadd -S = -a keys
}}
_catoptric() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
_catoptric "$@"
)zsh",
      fmt::join(fixed_keys(), " "), commands, cases);
}

std::string fish_completion(const ProgramWords& program) {
  std::string text = "# fish completion of catoptric; made by \"catoptric completion fish\"\n";
  for (const CommandWords& command : program.commands) {
    text += fmt::format("complete -c catoptric -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                        in_quotes(command.meaning));
    const std::string condition = fmt::format("'__fish_seen_subcommand_from {}'", command.name);
    for (const OptionWords& option : command.options) {
      std::vector<std::string> values = option.choices;
      if (option.name == "--set")
        for (const std::string& key : fixed_keys()) values.push_back(key + "=");
      const std::string offered =
          values.empty() ? "" : fmt::format(" -a {}", in_quotes(fmt::format("{}", fmt::join(values, " "))));
      if (option.name.starts_with("--"))
        text += fmt::format("complete -c catoptric -n {} -l {}{}{} -d {}\n", condition, option.name.substr(2),
                            option.value.empty() ? ""
                            : values.empty()     ? " -r"
                                                 : " -x",
                            offered, in_quotes(option.meaning));
      else if (!values.empty())
        text += fmt::format("complete -c catoptric -n {} -f{}\n", condition, offered);
    }
  }
  return text;
}

}  // namespace catoptric::cli

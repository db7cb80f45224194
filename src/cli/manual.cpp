#include "cli/manual.h"

#include <fmt/format.h>

#include <sstream>
#include <string_view>

#include "design/keys.h"
#include "report/result_json.h"

namespace catoptric::cli {
namespace {

/// Text as roff shows it as it stands.
std::string roff(std::string_view text) {
  std::string out;
  bool line_begins = true;
  for (const char letter : text) {
    if (line_begins && (letter == '.' || letter == '\'')) out += "\\&";
    if (letter == '\\')
      out += "\\e";
    else if (letter == '-')
      out += "\\-";
    else
      out += letter;
    line_begins = letter == '\n';
  }
  return out;
}

std::string title(std::string_view page, int section, std::string_view what) {
  return fmt::format(".TH {} {} \"\" \"catoptric {}\" \"{}\"\n", page, section, roff(report::version()),
                     what);
}

std::string option_text(const OptionWords& option) {
  std::string text = fmt::format(".TP\n\\fB{}\\fR", roff(option.name));
  if (!option.value.empty()) text += fmt::format(" \\fI{}\\fR", roff(option.value));
  return text + "\n" + roff(option.meaning) + "\n";
}

/// Lines as they stand.
std::string lines_text(const std::string& lines) {
  std::istringstream in(lines);
  std::string text = ".nf\n";
  for (std::string line; std::getline(in, line);) text += roff(line) + "\n";
  return text + ".fi\n";
}

std::string command_text(const CommandWords& command) {
  std::string text = fmt::format(".SS {}\n{}.\n", roff(command.name), roff(command.meaning));
  for (const OptionWords& option : command.options)
    if (option.name != "--help") text += option_text(option);
  return text + ".PP\n" + lines_text(command.footer);
}

}  // namespace

std::string program_manual(const ProgramWords& program) {
  std::string text = title("CATOPTRIC", 1, "User commands");
  text += ".SH NAME\ncatoptric \\- designs mirrors of revolution from the light they must make\n";
  text += ".SH SYNOPSIS\n\\fBcatoptric\\fR \\fICOMMAND\\fR \\fIFILE\\fR [\\fIOPTION\\fR]...\n";
  text += fmt::format(".SH DESCRIPTION\n{}\n", roff(program.meaning));
  text += roff(
      "A scene file states a source, the irradiance that is wanted on a surface and a mirror to start from, "
      "or none. "
      "The program finds the mirror, proves by independent photons what it does, and writes it as STEP and "
      "IGES. "
      "Keys of scene files: catoptric-scene(5).\n");
  text += ".SH OPTIONS\n";
  for (const OptionWords& option : program.options) text += option_text(option);
  text += ".SH COMMANDS\n";
  for (const CommandWords& command : program.commands) text += command_text(command);
  text +=
      ".SH ENVIRONMENT\n.TP\n\\fBNO_COLOR\\fR\nWhere it is set, no text is coloured; nor is it anywhere but "
      "on terminals.\n";
  text += ".SH EXAMPLES AND EXIT STATUS\n" + lines_text(program.footer);
  return text + ".SH SEE ALSO\n\\fBcatoptric\\-scene\\fR(5)\n";
}

std::string scene_manual() {
  std::string text = title("CATOPTRIC\\-SCENE", 5, "File formats");
  text += ".SH NAME\ncatoptric\\-scene \\- what a scene file of catoptric(1) may hold\n.SH DESCRIPTION\n";
  text += roff(
      "A scene is a TOML file. A star in a key stands for a name that is yours. Lengths are in the scene's "
      "unit.\n");
  std::string table;
  for (const design::Key& key : design::scene_keys()) {
    const std::string of(key.path.substr(0, key.path.find('.')));
    const std::string heading = of == key.path ? "general" : of;
    if (heading != table) text += fmt::format(".SH {}\n", roff(table = heading));
    text +=
        fmt::format(".TP\n\\fB{}\\fR\n{}.\n{}", roff(key.path), roff(key.meaning), roff(design::rule(key)));
    if (!key.standard.empty()) text += fmt::format("; default {}", roff(key.standard));
    text += ".\n";
  }
  return text + ".SH SEE ALSO\n\\fBcatoptric\\fR(1)\n";
}

}  // namespace catoptric::cli

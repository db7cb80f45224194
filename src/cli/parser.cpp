#include "cli/parser.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "design/keys.h"
#include "report/result_json.h"

namespace catoptric::cli {
namespace {

/// The options that every command on a scene takes.
void add_common(CLI::App& command, CommonOptions& options, const char* input) {
  command.add_option(input, options.input, "The file to work on")->required();
  command.add_option("--set", options.set, "Change a key of the scene: key=value; may be repeated")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_option("--out", options.out, "Folder for the results; out/<name> when left out")
      ->type_name("DIR");
  command.add_option("--threads", options.threads, "Threads to use; results do not depend on it")
      ->type_name("N");
  command.add_option("--seed", options.seed, "Key of all random numbers")->type_name("S");
  auto* quiet = command.add_flag("--quiet", options.quiet, "Print errors only");
  command.add_flag("--json", options.json, "Print one JSON object a line: progress, files, result, end")
      ->excludes(quiet);
}

struct Parser {
  CLI::App app{"Designs rotationally symmetric mirrors from the light they must make."};
  CommandLine line;
  std::vector<std::string> shells{"bash", "zsh", "fish"}, units{"mm", "cm", "m", "in"};
  std::vector<std::string> formats = export_format_names();

  Parser() {
    app.name("catoptric");
    app.require_subcommand(1);
    app.set_version_flag("--version", report::version());
    app.add_flag_callback(
        "--keys",
        [] {
          fmt::print("{}", design::reference(design::scene_keys()));
          throw CLI::Success();
        },
        "Print every key of a scene file with its meaning, rule and default");
    app.footer(
        "Examples:\n"
        "  catoptric design data/paper/start_a.toml --out out/a\n"
        "  catoptric simulate scene.toml --set model.photons=1000000\n"
        "  catoptric profile mirror.igs\n\n"
        "Exit codes: 0 done, 1 our bug, 2 usage, 3 scene invalid, 4 geometry or exchange,\n"
        "5 ended unconverged (files written), 6 cannot write, 130 interrupted (best so far written).");
    auto* designed = app.add_subcommand("design", "The whole job: search the mirror, verify, export, report");
    add_common(*designed, line.common, "SCENE.toml");
    designed->add_flag("--resume", line.design.resume,
                       "Go on with the search that was broken off in the same folder, to the same bits");
    designed->footer(
        "Example: catoptric design data/paper/start_a.toml --set search.acceleration=2\n"
        "After Ctrl-C or a kill: catoptric design SCENE.toml --out DIR --resume");
    add_common(
        *app.add_subcommand("simulate", "Irradiance of the scene as it stands")
             ->footer("Example: catoptric simulate data/paper/paraboloid.toml --set model.photons=1000000"),
        line.common, "SCENE.toml");
    auto* drawn =
        app.add_subcommand("landscape", "Objective over one or two variables, as table and contour plot");
    add_common(*drawn, line.common, "SCENE.toml");
    drawn
        ->add_option("--path", line.landscape.paths,
                     "convergence.csv of a search to draw over the contours; may be repeated")
        ->allow_extra_args(false)
        ->type_name("FILE");
    drawn->footer("Example: catoptric landscape data/paper/start_a.toml --path out/start_a/convergence.csv");
    auto* read = app.add_subcommand("profile",
                                    "Reads a generatrix from IGES or STEP and prints it as a scene fragment");
    read->add_option("FILE", line.common.input, "IGES or STEP file")->required();
    read->add_option("--index", line.profile.index, "Which of the file's curves, as numbered in the list")
        ->type_name("N");
    read->add_option("--axis", line.profile.axis, "Axis of revolution: a point in mm and a direction")
        ->expected(6)
        ->type_name("X Y Z DX DY DZ");
    read->add_option("--unit", line.profile.unit, "Unit of length of the fragment")
        ->check(CLI::IsMember(units))
        ->capture_default_str();
    read->footer("Example: catoptric profile data/profiles/start_a.igs --unit cm > fragment.toml");
    add_common(*app.add_subcommand("explain", "What will be modelled, what is left out, and why")
                    ->footer("Example: catoptric explain data/paper/start_a.toml"),
               line.common, "SCENE.toml");
    auto* written = app.add_subcommand("export", "Writes the scene's mirror as CAD files");
    add_common(*written, line.common, "SCENE.toml");
    written
        ->add_option(
            "--format", line.shape.formats,
            fmt::format("{}; may be repeated; step and iges when left out", fmt::join(formats, ", ")))
        ->check(CLI::IsMember(formats))
        ->allow_extra_args(false)
        ->type_name("FORMAT");
    written->footer(
        "Example: catoptric export data/paper/paraboloid.toml --format step --set reflector.wall=0.2");
    add_common(
        *app.add_subcommand("tradeoff", "Measures what accuracy costs on this scene: time against error")
             ->footer("Example: catoptric tradeoff data/paper/paraboloid.toml --out out/trade"),
        line.common, "SCENE.toml");
    add_common(
        *app.add_subcommand("sensitivity",
                            "How the light changes with what may be wrong; tolerances for the maker")
             ->footer(
                 "Example: catoptric sensitivity data/paper/paraboloid.toml --set sensitivity.allowed=0.05"),
        line.common, "SCENE.toml");
    add_common(
        *app.add_subcommand("intensity",
                            "The luminaire from afar: intensity, beam angles, flux by zone, IES and EULUMDAT")
             ->footer("Example: catoptric intensity data/examples/uniform_disc.toml --set "
                      "intensity.gamma_step=0.5"),
        line.common, "SCENE.toml");
    add_common(
        *app.add_subcommand("rays", "The scene's source, or its luminaire, as a ray file: TM-25 or Zemax")
             ->footer("Example: catoptric rays data/examples/torch_led.toml --set rays.count=2000000"),
        line.common, "SCENE.toml");
    add_common(*app.add_subcommand("study", "Runs a list of variations of a scene and prints one table")
                    ->footer("Example: catoptric study data/paper/table2.toml --out out/table2"),
               line.common, "STUDY.toml");
    auto* completed =
        app.add_subcommand("completion", "Prints what a shell needs to complete this command line");
    completed->add_option("SHELL", line.completion.shell, "bash, zsh or fish")
        ->required()
        ->check(CLI::IsMember(shells));
    completed->footer(
        "Example: catoptric completion bash > ~/.local/share/bash-completion/completions/catoptric");
    auto* manual = app.add_subcommand("manual", "Prints the manual page as roff");
    manual->add_flag("--scene", line.manual.scene, "That of scene files instead, with every key");
    manual->footer("Example: catoptric manual --scene | man -l -");
  }
};

std::vector<std::string> choices_of(const Parser& parser, const std::string& name) {
  if (name == "--format") return parser.formats;
  if (name == "--unit") return parser.units;
  if (name == "SHELL") return parser.shells;
  return {};
}

std::vector<OptionWords> option_words(const Parser& parser, const CLI::App& app) {
  std::vector<OptionWords> words;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    const bool takes_value = option->get_items_expected_max() > 0 && option->get_positional() == false;
    words.push_back({name, takes_value ? option->get_type_name() : "", option->get_description(),
                     choices_of(parser, name)});
  }
  return words;
}

/// The one of the names that is most like the mistyped one, if any is near.
std::string nearest(const std::vector<std::string>& names, std::string_view mistyped) {
  std::string best;
  std::size_t least = std::max<std::size_t>(1, mistyped.size() / 3) + 1;
  for (const std::string& name : names)
    if (const std::size_t distance = design::edit_distance(name, mistyped); distance < least) {
      least = distance;
      best = name;
    }
  return best;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

[[noreturn]] void refuse(const std::string& what, const std::string& meant, const std::string& else_try) {
  throw UsageError(
      {what, "command line", "", meant.empty() ? else_try : fmt::format("did you mean {}?", meant)});
}

/// A first word that is no command.
void require_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  const std::vector<std::string> names = command_names(app);
  if (std::ranges::count(names, argv[1]) > 0) return;
  refuse(fmt::format("\"{}\" is no command", argv[1]), nearest(names, argv[1]),
         "catoptric --help lists them");
}

/// What CLI11 objects to, with the option that may have been meant.
[[noreturn]] void refuse(const CLI::App& app, const CLI::ParseError& error) {
  const auto used = app.get_subcommands();
  const CLI::App& command = used.empty() ? app : *used.front();
  const std::string help =
      used.empty() ? "catoptric --help" : fmt::format("catoptric {} --help", command.get_name());
  for (const std::string& left : app.remaining(true))
    if (left.starts_with("-")) {
      std::vector<std::string> names;
      for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
      const std::string name = left.substr(0, left.find('='));
      refuse(fmt::format("{} has no option {}", command.get_name(), name), nearest(names, name), help);
    }
  refuse(error.what(), "", help);
}

}  // namespace

std::variant<CommandLine, ExitCode> parse(int argc, char** argv) {
  Parser parser;
  require_command(parser.app, argc, argv);
  try {
    parser.app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    parser.app.exit(asked);
    return ExitCode::done;
  } catch (const CLI::ParseError& error) {
    refuse(parser.app, error);
  }
  parser.line.command = parser.app.get_subcommands().front()->get_name();
  return parser.line;
}

ProgramWords program_words() {
  const Parser parser;
  ProgramWords words{
      parser.app.get_description(), parser.app.get_footer(), option_words(parser, parser.app), {}};
  for (const CLI::App* command : parser.app.get_subcommands([](const CLI::App*) { return true; }))
    words.commands.push_back({command->get_name(), command->get_description(), command->get_footer(),
                              option_words(parser, *command)});
  return words;
}

}  // namespace catoptric::cli

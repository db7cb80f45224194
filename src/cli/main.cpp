#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>

#include "base/errors.h"
#include "base/float_traps.h"
#include "cli/commands.h"
#include "design/keys.h"
#include "report/result_json.h"

namespace {

using namespace catoptric;
using namespace catoptric::cli;

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
  command.add_flag("--quiet", options.quiet, "Print errors only");
}

struct Parser {
  CLI::App app{"Designs rotationally symmetric mirrors from the light they must make."};
  CommonOptions common;
  DesignOptions design;
  LandscapeOptions landscape;
  ProfileOptions profile;
  ExportCommandOptions shape;

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
    add_common(*designed, common, "SCENE.toml");
    designed->add_flag("--resume", design.resume,
                       "Go on with the search that was broken off in the same folder, to the same bits");
    designed->footer(
        "Example: catoptric design data/paper/start_a.toml --set search.acceleration=2\n"
        "After Ctrl-C or a kill: catoptric design SCENE.toml --out DIR --resume");
    add_common(
        *app.add_subcommand("simulate", "Irradiance of the scene as it stands")
             ->footer("Example: catoptric simulate data/paper/paraboloid.toml --set model.photons=1000000"),
        common, "SCENE.toml");
    auto* drawn =
        app.add_subcommand("landscape", "Objective over one or two variables, as table and contour plot");
    add_common(*drawn, common, "SCENE.toml");
    drawn
        ->add_option("--path", landscape.paths,
                     "convergence.csv of a search to draw over the contours; may be repeated")
        ->allow_extra_args(false)
        ->type_name("FILE");
    drawn->footer("Example: catoptric landscape data/paper/start_a.toml --path out/start_a/convergence.csv");
    auto* read = app.add_subcommand("profile",
                                    "Reads a generatrix from IGES or STEP and prints it as a scene fragment");
    read->add_option("FILE", common.input, "IGES or STEP file")->required();
    read->add_option("--index", profile.index, "Which of the file's curves, as numbered in the list")
        ->type_name("N");
    read->add_option("--axis", profile.axis, "Axis of revolution: a point in mm and a direction")
        ->expected(6)
        ->type_name("X Y Z DX DY DZ");
    read->add_option("--unit", profile.unit, "Unit of length of the fragment")
        ->check(CLI::IsMember({"mm", "cm", "m", "in"}))
        ->capture_default_str();
    read->footer("Example: catoptric profile data/profiles/start_a.igs --unit cm > fragment.toml");
    add_common(*app.add_subcommand("explain", "What will be modelled, what is left out, and why")
                    ->footer("Example: catoptric explain data/paper/start_a.toml"),
               common, "SCENE.toml");
    auto* written = app.add_subcommand("export", "Writes the scene's mirror as CAD files");
    add_common(*written, common, "SCENE.toml");
    written
        ->add_option("--format", shape.formats,
                     "step, iges, brep, stl, glb, dxf; may be repeated; step and iges when left out")
        ->check(CLI::IsMember({"step", "iges", "brep", "stl", "glb", "dxf"}))
        ->allow_extra_args(false)
        ->type_name("FORMAT");
    written->footer(
        "Example: catoptric export data/paper/paraboloid.toml --format step --set reflector.wall=0.2");
    add_common(
        *app.add_subcommand("tradeoff", "Measures what accuracy costs on this scene: time against error")
             ->footer("Example: catoptric tradeoff data/paper/paraboloid.toml --out out/trade"),
        common, "SCENE.toml");
    add_common(
        *app.add_subcommand("sensitivity",
                            "How the light changes with what may be wrong; tolerances for the maker")
             ->footer(
                 "Example: catoptric sensitivity data/paper/paraboloid.toml --set sensitivity.allowed=0.05"),
        common, "SCENE.toml");
    add_common(
        *app.add_subcommand("intensity",
                            "The luminaire from afar: intensity, beam angles, flux by zone, IES and EULUMDAT")
             ->footer("Example: catoptric intensity data/examples/uniform_disc.toml --set "
                      "intensity.gamma_step=0.5"),
        common, "SCENE.toml");
    add_common(
        *app.add_subcommand("rays", "The scene's source, or its luminaire, as a ray file: TM-25 or Zemax")
             ->footer("Example: catoptric rays data/examples/torch_led.toml --set rays.count=2000000"),
        common, "SCENE.toml");
    add_common(*app.add_subcommand("study", "Runs a list of variations of a scene and prints one table")
                    ->footer("Example: catoptric study data/paper/table2.toml --out out/table2"),
               common, "STUDY.toml");
  }

  ExitCode run() {
    if (app.got_subcommand("design")) return design_command(common, design);
    if (app.got_subcommand("simulate")) return simulate_command(common);
    if (app.got_subcommand("explain")) return explain_command(common);
    if (app.got_subcommand("landscape")) return landscape_command(common, landscape);
    if (app.got_subcommand("tradeoff")) return tradeoff_command(common);
    if (app.got_subcommand("sensitivity")) return sensitivity_command(common);
    if (app.got_subcommand("intensity")) return intensity_command(common);
    if (app.got_subcommand("rays")) return rays_command(common);
    if (app.got_subcommand("profile")) return profile_command(common, profile);
    if (app.got_subcommand("export")) return export_command(common, shape);
    return study_command(common);
  }
};

int finish(ExitCode code) { return static_cast<int>(code); }

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error of the write, and ends with 6
  trap_float_errors();
  try {
    Parser parser;
    try {
      parser.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      const int code = parser.app.exit(error);
      return code == 0 ? finish(ExitCode::done) : finish(ExitCode::usage);
    }
    return finish(parser.run());
  } catch (const Error& error) {
    fmt::print(stderr, "catoptric: {}\n", error.what());
    return finish(error.exit_code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "catoptric: a mistake of this program, please report it: {}\n", error.what());
    return finish(ExitCode::our_bug);
  }
}

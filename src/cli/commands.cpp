#include "cli/commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <new>

#include "cli/command_line.h"
#include "core/error.h"

namespace hemibake {

// One per file in cli/.
CommandBody setup_compare(CLI::App& app);
CommandBody setup_curves(CLI::App& app);
CommandBody setup_export(CLI::App& app);
CommandBody setup_fit(CLI::App& app);
CommandBody setup_render(CLI::App& app);
CommandBody setup_report(CLI::App& app);
CommandBody setup_synth(CLI::App& app);
CommandBody setup_bake(CLI::App& app);
CommandBody setup_check(CLI::App& app);
CommandBody setup_run(CLI::App& app);
CommandBody setup_trade(CLI::App& app);

namespace {

constexpr int kExitFailedCheck = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitInterrupted = 130;

constexpr std::array kCommands = {
    Command{"synth", "write a synthetic height map", setup_synth},
    Command{"bake", "trace the light on a height map", setup_bake},
    Command{"curves", "sort the texels of a bake by AO: mean and spread of every bounce", setup_curves},
    Command{"fit", "fit models to curves", setup_fit},
    Command{"compare", "fit every candidate model to each of several curves, measure it on the others",
            setup_compare},
    Command{"export", "write a fitted model as shader source or a table", setup_export},
    Command{"render",
            "pictures of a bake: AO only, model, ground truth, their differences, the bounces, the wall",
            setup_render},
    Command{"check", "check that light is neither made nor lost", setup_check},
    Command{"run", "bake, curves, fit and check in one go", setup_run},
    Command{"trade", "what every method costs and how far off it is, against a converged reference",
            setup_trade},
    Command{"report", "one self-contained HTML page of what 'run' wrote", setup_report},
};

// One line, whatever a file name or a library puts into it.
int fail(int code, std::string message) {
  std::ranges::replace_if(
      message, [](unsigned char c) { return c < ' '; }, ' ');
  fmt::print(stderr, "hemibake: {}\n", message);
  return code;
}

// An unset shell variable in quotes is never what was meant: `--links "$LINKS"` would write no links and say
// nothing.
void refuse_empty_arguments(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')
      throw InputError(fmt::format("{}: is followed by an empty argument, expected a name or a value",
                                   i == 1 ? "hemibake" : argv[i - 1]));
}

// What CLI11 says of a command that is missing or unknown names neither it nor the others.
std::string describe_error(const CLI::ParseError& error, const CLI::App& app, int argc, char** argv) {
  if (!app.get_subcommands().empty()) return error.what();
  std::string names;
  for (const Command& command : kCommands) names += (names.empty() ? "" : ", ") + std::string(command.name);
  return fmt::format("{}, expected one of {}",
                     argc > 1 ? fmt::format("'{}' is no command", argv[1]) : "no command", names);
}

int run_guarded(const CommandBody& body) {
  try {
    return body();
  } catch (const InputError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const CheckError& error) {
    return fail(kExitFailedCheck, error.what());
  } catch (const Interrupted&) {
    return fail(kExitInterrupted, "interrupted, no file was left half written");
  } catch (const std::bad_alloc&) {
    return fail(kExitBadInput, "out of memory, expected less work (see --dry-run and --memory)");
  } catch (const std::exception& error) {
    return fail(kExitFailedCheck, error.what());
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  set_command_line(argc, argv);
  CLI::App app{"hemibake " HEMIBAKE_VERSION
               ": bakes the light on a height map and fits models of it for shaders."};
  app.set_version_flag("--version", HEMIBAKE_VERSION);
  app.require_subcommand(1);
  CommandBody chosen;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    CommandBody body = command.setup(*sub);
    sub->callback([&chosen, body = std::move(body)] { chosen = body; });
  }
  try {
    refuse_empty_arguments(argc, argv);
    app.parse(argc, argv);
  } catch (const InputError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kExitBadInput, describe_error(error, app, argc, argv));
  }
  return run_guarded(chosen);
}

}  // namespace hemibake

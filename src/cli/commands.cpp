#include "cli/commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <new>

#include "core/error.h"

namespace hemibake {

// One per file in cli/.
CommandBody setup_curves(CLI::App& app);
CommandBody setup_fit(CLI::App& app);
CommandBody setup_synth(CLI::App& app);
CommandBody setup_bake(CLI::App& app);
CommandBody setup_check(CLI::App& app);
CommandBody setup_run(CLI::App& app);

namespace {

constexpr int kExitFailedCheck = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitInterrupted = 130;

constexpr std::array kCommands = {
    Command{"synth", "write a synthetic height map", setup_synth},
    Command{"bake", "trace the light on a height map", setup_bake},
    Command{"curves", "sort the texels of a bake by AO: mean and spread of every bounce", setup_curves},
    Command{"fit", "fit models to curves", setup_fit},
    Command{"check", "check that light is neither made nor lost", setup_check},
    Command{"run", "bake, curves, fit and check in one go", setup_run},
};

int fail(int code, const std::string& message) {
  fmt::print(stderr, "hemibake: {}\n", message);
  return code;
}

int run_guarded(const CommandBody& body) {
  try {
    return body();
  } catch (const InputError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const CheckError& error) {
    return fail(kExitFailedCheck, error.what());
  } catch (const Interrupted&) {
    return fail(kExitInterrupted, "interrupted, nothing was written");
  } catch (const std::bad_alloc&) {
    return fail(kExitBadInput, "out of memory, expected less work (see --dry-run and --memory)");
  } catch (const std::exception& error) {
    return fail(kExitFailedCheck, error.what());
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"hemibake " HEMIBAKE_VERSION ": bakes the light on a height map and fits models of it for shaders."};
  app.set_version_flag("--version", HEMIBAKE_VERSION);
  app.require_subcommand(1);
  CommandBody chosen;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    CommandBody body = command.setup(*sub);
    sub->callback([&chosen, body = std::move(body)] { chosen = body; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(kExitBadInput, error.what());
  }
  return run_guarded(chosen);
}

}  // namespace hemibake

#include "cli/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>

#include "bake/settings.h"
#include "cli/command_line.h"
#include "cli/options/parser.h"
#include "cli/print/progress_line.h"
#include "cli/print/warnings.h"
#include "cli/signals.h"
#include "core/error.h"
#include "io/provenance.h"
#include "tracers/slice/instruction_sets.h"

namespace hemibake {

// One per file in cli/.
CommandSetup setup_synth();
CommandSetup setup_bake();
CommandSetup setup_textures();
CommandSetup setup_curves();
CommandSetup setup_fit();
CommandSetup setup_compare();
CommandSetup setup_export();
CommandSetup setup_render();
CommandSetup setup_check();
CommandSetup setup_run();
CommandSetup setup_trade();
CommandSetup setup_report();

namespace {

constexpr int kExitFailedCheck = 1;
constexpr int kExitBadInput = 2;
constexpr int kExitInterrupted = 130;

constexpr std::array kCommands = {
    Command{"synth", "write a synthetic height map", setup_synth},
    Command{"bake", "trace the light on a height map", setup_bake},
    Command{"textures", "images of a bake for an engine: AO, bent normals, light, packed", setup_textures},
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

int fail(int code, const std::string& message) {
  print_error(message);
  return code;
}

Context context_of(const ParsedCommand& parsed, int argc, char** argv) {
  Context context;
  context.threads = parsed.threads;
  if (isatty(STDERR_FILENO) == 1) context.progress = draw_progress_line;
  context.cancel = &install_signal_handlers();
  context.command = command_line({argv, argv + argc});
  return context;
}

int run(const ParsedCommand& parsed, const Context& context) {
  const ContextScope scope(context);
  return parsed.setup.run({context, parsed.given, parsed.json});
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

int run_command_line(int argc, char** argv) {
  try {
    // For tests: the bytes of a bake are the same on each.
    if (const char* name = std::getenv("HEMIBAKE_TARGETS")) use_instruction_set(name);
    const auto parsed = parse_command_line(argc, argv, kCommands);
    return parsed ? run(*parsed, context_of(*parsed, argc, argv)) : 0;
  } catch (const SettingError& error) {
    return fail(kExitBadInput, error.with_prefix("--"));
  } catch (const InputError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const CheckError& error) {
    return fail(kExitFailedCheck, error.what());
  } catch (const Cancelled&) {
    return fail(kExitInterrupted, "interrupted, no file was left half written");
  } catch (const std::bad_alloc&) {
    return fail(kExitBadInput, "out of memory, expected less work (see --dry-run and --memory)");
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again)
      return fail(kExitFailedCheck, error.what());
    return fail(kExitBadInput, "no thread could be started, expected more memory or fewer --threads");
  } catch (const std::exception& error) {
    return fail(kExitFailedCheck, error.what());
  }
}

}  // namespace hemibake

#include "cli/commands.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <exception>

#include "bake/settings.h"
#include "cli/command_line.h"
#include "cli/ending.h"
#include "cli/options/parser.h"
#include "cli/print/progress_line.h"
#include "cli/print/streams.h"
#include "cli/signals.h"
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

Context context_of(const ParsedCommand& parsed, const std::atomic<bool>& cancel, int argc, char** argv) {
  Context context;
  context.threads = parsed.threads;
  if (isatty(STDERR_FILENO) == 1) context.progress = draw_progress_line;
  context.cancel = &cancel;
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
  open_standard_streams();
  end_on_uncaught_exceptions();
  const std::atomic<bool>& cancel = install_signal_handlers();
  try {
    // For tests: the bytes of a bake are the same on each.
    if (const char* name = std::getenv("HEMIBAKE_TARGETS")) use_instruction_set(name);
    const auto parsed = parse_command_line(argc, argv, kCommands);
    return parsed ? run(*parsed, context_of(*parsed, cancel, argc, argv)) : 0;
  } catch (...) {
    const Ending ending = ending_of(std::current_exception());
    print_message(ending.message);
    return ending.exit_code;
  }
}

}  // namespace hemibake

// hemibake: find the command, run it, turn an error into one line and an exit code.
#include "cli/commands.h"
#include "core/interrupt.h"

int main(int argc, char** argv) {
  hemibake::install_signal_handlers();
  return hemibake::run_command_line(argc, argv);
}

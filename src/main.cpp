#include "cli/commands.h"

int main(int argc, char** argv) { return hemibake::run_command_line(argc, argv); }

// The standard streams: everything printed goes through here, and nothing printed can throw or end the
// program.
#pragma once

#include <string_view>

namespace hemibake {

// Opens the standard streams that are closed, so that no file of the program gets their numbers. Reading from
// them then finds the end; writing to standard output fails, to standard error goes nowhere.
void open_standard_streams();

// Prints a result on standard output, control characters replaced. Throws InputError where it cannot be
// written.
void print_result(std::string_view text);

// Prints "hemibake: MESSAGE" on standard error as one line, whatever a file name puts into it. A stream that
// takes nothing is left alone.
void print_message(std::string_view message);

// Writes bytes to standard error as they are, as far as it takes them.
void write_to_standard_error(std::string_view bytes);

}  // namespace hemibake

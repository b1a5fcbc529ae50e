// Numbers on the command line, stricter than CLI11's own ranges. Each complains with "VALUE, expected …".
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace hemibake {

// low..high; CLI11's ranges let NaN through, as every comparison with it is false.
CLI::Validator number_in(double low, double high);

// Above 0, up to `high`.
CLI::Validator positive_to(double high);

// low..high in decimal digits; CLI11 takes −1 for 2⁶⁴ − 1, 2⁶⁴ for the same, and 010 for 8.
CLI::Validator whole_number_in(uint64_t low, uint64_t high);

}  // namespace hemibake

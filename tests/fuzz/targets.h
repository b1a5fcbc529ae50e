// The readers of hemibake as functions of bytes, for fuzzing and for replaying what fuzzing found.
#pragma once

#include <span>
#include <string_view>

namespace hemibake {

struct FuzzTarget {
  const char* name;                     // also of its folder of the corpus
  void (*read)(std::string_view file);  // may throw anything
};

// Returns every target, in alphabetical order.
std::span<const FuzzTarget> fuzz_targets();

// Returns the target of that name; null: there is none.
const FuzzTarget* find_fuzz_target(std::string_view name);

// Reads bytes. Ends the process where the reader throws anything but InputError, which includes SettingError.
void run_fuzz_target(const FuzzTarget& target, std::string_view bytes);

}  // namespace hemibake

// The vector instructions that slices and the bounces run on, for tests: a machine chooses its best by
// itself.
#pragma once

#include <string>
#include <vector>

namespace hemibake {

// Returns the sets that this machine has and the library is built for, best first: "AVX3", "AVX2", "SSE4".
std::vector<std::string> instruction_sets();

// Makes the whole process use one set from here on. Throws InputError listing them where `name` is none.
void use_instruction_set(const std::string& name);

}  // namespace hemibake

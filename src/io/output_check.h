// Keeps outputs off inputs, whatever names lead to them.
#pragma once

#include <filesystem>
#include <vector>

namespace hemibake {

// Throws InputError where an output is an input, or another output: the same file by device and number,
// through symbolic and hard links too. Empty paths and inputs that are not there are left out.
void refuse_overwriting_inputs(const std::vector<std::filesystem::path>& outputs,
                               const std::vector<std::filesystem::path>& inputs);

}  // namespace hemibake

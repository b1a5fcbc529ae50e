// How a result was made: what every file written carries with it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hemibake {

// A JSON object of names and scalars (string, boolean, integer, finite number), in the order added. Nothing
// in it may depend on the time, the host or the number of threads where the file is to be the same at every
// run.
using Provenance = nlohmann::ordered_json;

// `version`, `command` (a line from command_line()), `input` (the file's name without its folder) and
// `input_sha256`. Throws InputError where the input cannot be read.
Provenance make_provenance(std::string_view command, const std::filesystem::path& input);

// `version` and `command`, for what is made from no input.
Provenance make_provenance(std::string_view command);

// Throws std::logic_error naming the entry where `provenance` is not as described above, or a name is empty
// or "provenance" (which is what files call the whole).
void check_provenance(const Provenance& provenance);

// The arguments this process was started with, the program's name first.
std::vector<std::string> process_arguments();

// One line that makes the same result again in a POSIX shell: "hemibake bake 'my map.png' --rays 64". Left
// out is what changes no byte of a result: --threads N, --json, -o / --output FILE, and the folder the
// program lies in.
std::string command_line(const std::vector<std::string>& arguments);

// 64 hexadecimal digits. Throws InputError where the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

// `text` with every byte that is not UTF-8 replaced by U+FFFD (file names may hold any byte; JSON and HDF5
// may not).
std::string valid_utf8(std::string_view text);

}  // namespace hemibake

// Which file an error is about: what is below io/ knows the data, the command knows where they came from.
#pragma once

#include <filesystem>

#include "core/error.h"

namespace hemibake {

// work(), with "FILE: " put before the message of an InputError or CheckError.
template <class Work>
auto with_file_context(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const SettingError& error) {
    throw error.in_file(path.string());
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  } catch (const CheckError& error) {
    throw CheckError(path.string() + ": " + error.what());
  }
}

}  // namespace hemibake

// The version of hemibake.
#pragma once

namespace hemibake {

extern const char* const kVersion;  // "0.2.0"

}  // namespace hemibake

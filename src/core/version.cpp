#include "core/version.h"

namespace hemibake {

const char* const kVersion = HEMIBAKE_VERSION;

}  // namespace hemibake

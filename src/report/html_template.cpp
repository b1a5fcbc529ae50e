// Carries the page that src/report/web/ was built into as bytes of this program (CMake gives its path).
#include <string_view>

#include "report/html_page.h"

asm(".section .rodata\n"
    "hemibake_page_begin:\n"
    ".incbin \"" HEMIBAKE_PAGE_FILE
    "\"\n"
    "hemibake_page_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const char hemibake_page_begin[], hemibake_page_end[];

namespace hemibake {

std::string_view page_template() {
  return {hemibake_page_begin, static_cast<size_t>(hemibake_page_end - hemibake_page_begin)};
}

}  // namespace hemibake

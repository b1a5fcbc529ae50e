// Stands for the page in a build without Node.
#include "report/html_page.h"

namespace hemibake {

std::string_view page_template() { return {}; }

}  // namespace hemibake

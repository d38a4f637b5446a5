// The bytes of web/dist/view.html (TAILWATER_PAGE). Only this file is compiled with their path, so it is separate.
#include "server/page.h"

#include <cstddef>

// clang-format off
__asm__(".pushsection .rodata\n"
        "tailwater_page_begin:\n"
        ".incbin \"" TAILWATER_PAGE "\"\n"
        "tailwater_page_end:\n"
        ".byte 0\n"
        ".popsection\n");
// clang-format on
extern "C" const char tailwater_page_begin[];
extern "C" const char tailwater_page_end[];

namespace tailwater {

std::string_view view_page() {
  return {tailwater_page_begin, static_cast<std::size_t>(tailwater_page_end - tailwater_page_begin)};
}

}  // namespace tailwater

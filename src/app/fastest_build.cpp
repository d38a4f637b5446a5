#include "app/fastest_build.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "app/processes.h"
#include "base/error.h"

namespace tailwater {

void become_fastest_build([[maybe_unused]] char** arguments) {
#if defined(__x86_64__)
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#if defined(__AVX2__)
  if (!has_v3) {  // in place of an illegal instruction
    std::fputs("error: this program is built for processors with AVX2 (" TAILWATER_ARCH
               "), which this one lacks; remedy: the Debian package, which runs on all, or a build with cmake -D "
               "TAILWATER_ARCH=x86-64-v2\n",
               stderr);
    std::exit(static_cast<int>(ExitCode::bad_input));
  }
#endif
  if (std::string_view(TAILWATER_ARCH) != "x86-64-v2" || !has_v3) return;
  const char* wanted = std::getenv("TAILWATER_ARCH");
  if (wanted != nullptr && std::string_view(wanted) == "x86-64-v2") return;
  const std::filesystem::path faster =
      std::filesystem::path(this_program()).parent_path().parent_path() / "lib" / "tailwater" / "tailwater-v3";
  if (access(faster.c_str(), X_OK) == 0) execv(faster.c_str(), arguments);
#endif
}

}  // namespace tailwater

#include "app/fastest_build.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "app/processes.h"

namespace tailwater {

void become_fastest_build([[maybe_unused]] char** arguments) {
#if defined(__x86_64__)
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  if (std::string_view(TAILWATER_ARCH) != "x86-64-v2" || !has_v3) return;
  const char* wanted = std::getenv("TAILWATER_ARCH");
  if (wanted != nullptr && std::string_view(wanted) == "x86-64-v2") return;
  const std::filesystem::path faster =
      std::filesystem::path(this_program()).parent_path().parent_path() / "lib" / "tailwater" / "tailwater-v3";
  if (access(faster.c_str(), X_OK) == 0) execv(faster.c_str(), arguments);
#endif
}

}  // namespace tailwater

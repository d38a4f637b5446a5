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
#if defined(__x86_64__) && defined(TAILWATER_HAS_FASTER)
  const bool has_v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  const char* asked = std::getenv("TAILWATER_ARCH");
  const std::string_view wanted = asked != nullptr ? asked : has_v3 ? "x86-64-v3" : "x86-64-v2";
  if (wanted == "x86-64-v2") return;
  if (wanted != "x86-64-v3") {
    std::fprintf(stderr, "error: TAILWATER_ARCH=%s in the environment: there are x86-64-v2 and x86-64-v3\n", asked);
    std::exit(static_cast<int>(ExitCode::bad_input));
  }
  const std::filesystem::path prefix = std::filesystem::path(this_program()).parent_path().parent_path();
  execv((prefix / "lib" / "tailwater" / "tailwater-v3").c_str(), arguments);  // absent in a build tree
#endif
}

}  // namespace tailwater

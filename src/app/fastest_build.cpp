#include "app/fastest_build.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "app/processes.h"
#include "base/error.h"

namespace tailwater {
namespace {

[[noreturn, maybe_unused]] void refuse(const std::string& what) {
  std::fputs(("error: " + what + "\n").c_str(), stderr);
  std::exit(static_cast<int>(ExitCode::bad_input));
}

}  // namespace

void become_fastest_build([[maybe_unused]] char** arguments) {
#if defined(__x86_64__)
  [[maybe_unused]] const bool has_v3 =
      __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
#if defined(__AVX2__)
  if (!has_v3) {  // in place of an illegal instruction
    refuse("this program is built for processors with AVX2 (" TAILWATER_ARCH
           "), which this one lacks; remedy: TAILWATER_ARCH=x86-64-v2 in the environment, if it is that of the Debian "
           "package; else a build with cmake -D TAILWATER_ARCH=x86-64-v2");
  }
#elif defined(TAILWATER_HAS_FASTER)
  const char* asked = std::getenv("TAILWATER_ARCH");
  const std::string_view wanted = asked != nullptr ? asked : has_v3 ? "x86-64-v3" : "x86-64-v2";
  if (wanted == "x86-64-v2") return;
  if (wanted != "x86-64-v3") {
    refuse("TAILWATER_ARCH=" + std::string(wanted) + " in the environment: there are x86-64-v2 and x86-64-v3");
  }
  const std::filesystem::path prefix = std::filesystem::path(this_program()).parent_path().parent_path();
  execv((prefix / "lib" / "tailwater" / "tailwater-v3").c_str(), arguments);  // not there in a build tree
#endif
#endif
}

}  // namespace tailwater

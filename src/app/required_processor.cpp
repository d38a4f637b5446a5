// A program that is built for AVX2 ends with a message on a processor without AVX2, instead of with an illegal
// instruction. The test must run before any C++ initialisation, including that of libraries, which call templates that
// are compiled here. It is therefore an entry of .preinit_array, which the loader runs first. It must not contain such
// an instruction itself.
#include <unistd.h>

#include <cstring>

#if defined(__x86_64__) && defined(__AVX2__)
namespace {

__attribute__((target("arch=x86-64"), no_sanitize("address", "undefined"))) void require_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) return;
  const char* told = "error: this is built for processors with AVX2 (" TAILWATER_ARCH
                     "), which this one lacks; remedy: a build with cmake -D TAILWATER_ARCH=x86-64-v2, or the Debian "
                     "package, which has one (TAILWATER_ARCH=x86-64-v2 in the environment chooses it)\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, told, std::strlen(told));
  _exit(2);
}

__attribute__((section(".preinit_array"), used)) void (*const run_first)() = require_processor;

}  // namespace
#endif

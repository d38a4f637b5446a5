// A program that is built for AVX2 ends with a word on a processor without it, in place of an illegal instruction. That
// must be before anything of C++ is initialised, of libraries too, which call templates that are compiled here: as an
// entry of .preinit_array, which the loader runs first. And it must have no such instruction of its own.
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

// Floating-point traps: a division by zero, an overflow or an invalid operation stops the program where it happens. On
// in all tests, and in the program with TAILWATER_FP_TRAPS=1 in the environment.
#pragma once

#include <cfenv>

namespace tailwater {

inline void enable_fp_traps() { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW); }

/// Suspends the traps for calls into libraries that raise and handle such exceptions themselves.
class SuspendFpTraps {
 public:
  SuspendFpTraps() : enabled_(fedisableexcept(FE_ALL_EXCEPT)) {}
  ~SuspendFpTraps() {
    feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(enabled_);
  }
  SuspendFpTraps(const SuspendFpTraps&) = delete;
  SuspendFpTraps& operator=(const SuspendFpTraps&) = delete;

 private:
  int enabled_;
};

}  // namespace tailwater

// Excludes the memory that libraries keep from their start to the end of the process from the reports of the leak
// checker.
#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace tailwater {

/// The leak checker ignores all memory allocated during the lifetime of this object.
struct IgnoreLeaks {
#ifdef __SANITIZE_ADDRESS__
  IgnoreLeaks() { __lsan_disable(); }
  ~IgnoreLeaks() { __lsan_enable(); }
#else
  IgnoreLeaks() {}  // NOLINT(modernize-use-equals-default): a trivial constructor would leave the variable unused
#endif
};

}  // namespace tailwater

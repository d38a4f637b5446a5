// What libraries keep from their start until the process ends, the leak checker need not report.
#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace tailwater {

/// Leaves out what is allocated as long as it lives.
struct IgnoreLeaks {
#ifdef __SANITIZE_ADDRESS__
  IgnoreLeaks() { __lsan_disable(); }
  ~IgnoreLeaks() { __lsan_enable(); }
#else
  IgnoreLeaks() {}  // NOLINT(modernize-use-equals-default): a trivial one would leave the variable unused
#endif
};

}  // namespace tailwater

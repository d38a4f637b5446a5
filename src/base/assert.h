// TAILWATER_ASSERT(condition, message): a broken invariant of the program, never a user's mistake.
// On in the presets debug, asan and audit; compiled away in release.
#pragma once

#ifdef TAILWATER_ASSERTIONS
#include <cstdio>
#include <cstdlib>
#define TAILWATER_ASSERT(condition, message)                                                               \
  do {                                                                                                     \
    if (!(condition)) {                                                                                    \
      std::fprintf(stderr, "%s:%d: broken invariant: %s (%s)\n", __FILE__, __LINE__, message, #condition); \
      std::abort();                                                                                        \
    }                                                                                                      \
  } while (false)
#else
#define TAILWATER_ASSERT(condition, message) ((void)0)
#endif

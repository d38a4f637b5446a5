// Ctrl-C, SIGTERM and SIGUSR1 (batch systems, app/ranks.h) end a run in order: the present step is finished and
// everything written so far stays usable.
#pragma once

#include <csignal>

namespace tailwater {

/// While it lives, the first SIGINT, SIGTERM or SIGUSR1 only raises a flag; a second one ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool requested() const;

 private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
  struct sigaction old_user_ {};
};

}  // namespace tailwater

// Replaces the C library's sched_yield, which a waiting rank calls repeatedly if Open MPI is set to yield. The
// replacement sleeps, for longer the longer the rank has waited. Four ranks that spin on two cores would leave no time
// to those that they wait for.
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <ctime>

extern "C" int sched_yield() noexcept {
  using namespace std::chrono;
  using Clock = steady_clock;
  constexpr microseconds shortest{20};
  constexpr microseconds longest{2000};
  constexpr microseconds looks{2};  // time between two looks; a later call follows other work
  static Clock::time_point began;
  static Clock::time_point slept;
  const Clock::time_point now = Clock::now();
  if (now - slept > looks) began = now;
  const nanoseconds moment = std::clamp<nanoseconds>((now - began) / 16, shortest, longest);
  const timespec time{.tv_sec = 0, .tv_nsec = moment.count()};
  nanosleep(&time, nullptr);
  slept = Clock::now();
  return 0;
}

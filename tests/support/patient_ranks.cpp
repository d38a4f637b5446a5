// In place of the C library's sched_yield, which a rank that waits calls again and again where Open MPI is told to
// yield: it sleeps, the longer the longer it has waited. Four ranks that spin on two cores leave none to those that
// they wait for.
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <ctime>

extern "C" int sched_yield() noexcept {
  using namespace std::chrono;
  using Clock = steady_clock;
  constexpr microseconds shortest{20};
  constexpr microseconds longest{2000};
  constexpr microseconds looks{2};  // for what is waited for; who comes later has done something between
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

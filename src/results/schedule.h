// The times of an output at whole multiples of an interval: it is due at the first step at or after each.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json.h"

namespace tailwater {

class Schedule {
 public:
  /// `interval` [s] is above 0.
  explicit Schedule(double interval) : interval_(interval) {}

  bool is_due(double time) const { return time >= next_; }
  /// Sets the next time, at the time of a completed output.
  void set_next(double time) { next_ = (std::floor(time / interval_) + 1.0) * interval_; }

  /// s; of the last output, or -1.
  double last() const { return last_; }
  void set_last(double time) { last_ = time; }

  /// For a checkpoint, and from one of a run whose interval may have been another.
  Json saved() const { return {{"interval", interval_}, {"next", next_}, {"last", last_}}; }
  void restore(const Json& saved) {
    saved.at("next").get_to(next_);
    saved.at("last").get_to(last_);
    if (saved.at("interval") != interval_) set_next(last_);
  }

 private:
  double interval_;     ///< s
  double next_ = 0.0;   ///< s
  double last_ = -1.0;  ///< s
};

}  // namespace tailwater

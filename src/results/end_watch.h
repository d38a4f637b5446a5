// Watches whether the open ends of a run do what the case asks of them, and warns once of each that does not.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "flow/flow.h"

namespace tailwater {

class OpenEndMonitor {
 public:
  /// Warns of levels that are not held (LevelError) and of inlets that bring less than they should. Call after each
  /// step; only the root's warnings are seen.
  template <int Dim>
  void update(const Flow<Dim>& flow);
  /// Warns again of levels that were not held: for how long, and whether they are now. Call at the end of the run.
  template <int Dim>
  void warn_of_end(const Flow<Dim>& flow) const;

  /// What has been warned of, for a checkpoint, and from one.
  Json saved() const;
  void restore(const Json& saved);

 private:
  /// Whether nothing of this kind was told of this end yet; from now on it was.
  bool is_first(const std::string& what);

  std::vector<std::string> told_;
};

}  // namespace tailwater

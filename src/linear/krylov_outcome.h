// How a Krylov method ended.
#pragma once

#include <vector>

namespace tailwater {

struct KrylovOutcome {
  int iterations = 0;
  bool broke_down = false;      ///< the method cannot go on; another may
  double residual = 0.0;        ///< norm of b - A x
  std::vector<double> history;  ///< residuals on the way, estimated or known; the first is the start's
};

}  // namespace tailwater

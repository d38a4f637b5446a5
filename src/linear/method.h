// A method that solves a LinearSystem from a first guess on: our own BiCGStab (bicgstab.h), Orthomin around our own
// multigrid (orthomin.h), or any of PETSc's (petsc_method.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "linear/linear_system.h"

namespace tailwater {

/// A solution on its way.
struct Iterate {
  std::span<double> x;
  std::vector<double> residual;  ///< b - A x when a method begins; what it leaves here is its own affair
};

/// Where a method ends.
struct Goal {
  double tolerance;  ///< |b - A x| / |b|
  double residual;   ///< the same, |b - A x|
  int iterations;    ///< at most
};

/// How a method ended.
struct MethodOutcome {
  enum class End {
    converged,   ///< by the residual that the method measures
    broke_down,  ///< it cannot go on; another method may
    unfinished,  ///< it had no more iterations, or the system is not for it
  };
  End end = End::unfinished;
  std::string reason;                   ///< what the method did, for the user
  int iterations = 0;                   ///< that it took
  std::optional<double> residual = {};  ///< |b - A x|, if the method knows it
  std::vector<double> history = {};     ///< residuals on the way, in a unit of the method; the first is the start's

  MethodOutcome& break_down(std::string why) {
    end = End::broke_down;
    reason = std::move(why);
    return *this;
  }
};

class Method {
 public:
  virtual ~Method() = default;

  /// Comes before each solve, also before one whose guess will do: `residual` is that of the guess, |b - A x| / |b|.
  /// Collective.
  virtual void begin(const LinearSystem& system, double residual) = 0;

  /// Improves x up to the goal. Collective.
  virtual MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) = 0;
};

}  // namespace tailwater

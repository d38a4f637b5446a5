// A method that solves a LinearSystem from a first guess: our own BiCGStab (bicgstab.h), Orthomin around our own
// multigrid (orthomin.h), or any method of PETSc (petsc_method.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "linear/linear_system.h"

namespace tailwater {

/// An approximate solution that a method improves.
struct Iterate {
  std::span<double> x;
  std::vector<double> residual;  ///< b - A x when a method begins; undefined after it
};

/// The criterion by which a method ends.
struct Goal {
  double tolerance;  ///< |b - A x| / |b|
  double residual;   ///< |b - A x|
  int iterations;    ///< maximum number of iterations
};

/// How a method ended.
struct MethodOutcome {
  enum class End {
    converged,   ///< according to the residual that the method measures
    broke_down,  ///< it cannot continue; another method may
    unfinished,  ///< the iterations are used up, or the method does not suit the system
  };
  End end = End::unfinished;
  std::string reason;                   ///< result of the method, for the user
  int iterations = 0;                   ///< number of iterations used
  std::optional<double> residual = {};  ///< |b - A x|, if the method computes it
  /// residuals of the iterations, in a unit of the method; the first is that of the start
  std::vector<double> history = {};

  MethodOutcome& break_down(std::string why) {
    end = End::broke_down;
    reason = std::move(why);
    return *this;
  }
};

class Method {
 public:
  virtual ~Method() = default;

  /// Called before each solve, even if the guess is already good enough: `residual` is that of the guess, |b - A x| /
  /// |b|. Collective.
  virtual void begin(const LinearSystem& system, double residual) = 0;

  /// Improves x up to the goal. Collective.
  virtual MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) = 0;
};

}  // namespace tailwater

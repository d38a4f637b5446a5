// The errors that a user can cause, as opposed to broken invariants (assert.h). Each kind has its exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace tailwater {

enum class ExitCode : int {
  done = 0,
  bad_input = 2,
  solver_failed = 3,
  io_failed = 4,
  interrupted = 130,
};

/// Base of all errors that end a command with a message to its user.
class UserError : public std::runtime_error {
 public:
  UserError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// A UserError with this exit code, from a message or from arguments of fmt::format.
template <ExitCode exit_code>
class ErrorWith : public UserError {
 public:
  explicit ErrorWith(const std::string& message) : UserError(exit_code, message) {}
  template <class First, class... Rest>
  explicit ErrorWith(fmt::format_string<First, Rest...> text, First&& first, Rest&&... rest)
      : UserError(exit_code, fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...)) {}
};

/// The case file, the command line or the geometry is wrong. The message names the place, the value and the remedy.
using InputError = ErrorWith<ExitCode::bad_input>;
/// A linear solve did not converge, or a step produced a value that is not finite.
using SolverError = ErrorWith<ExitCode::solver_failed>;
/// A file or folder cannot be read or written.
using IoError = ErrorWith<ExitCode::io_failed>;

}  // namespace tailwater

#include "parallel/together.h"

#include <algorithm>

namespace tailwater {

void do_together(const Communicator& ranks, const std::function<void()>& work) {
  if (ranks.is_alone()) {
    work();
    return;
  }
  ExitCode code = ExitCode::done;
  std::string message;
  try {
    work();
  } catch (const UserError& error) {
    code = error.code();
    message = error.what();
  }
  const std::vector<ExitCode> codes = ranks.all_gather(code);
  const auto first = std::find_if(codes.begin(), codes.end(), [](ExitCode c) { return c != ExitCode::done; });
  if (first == codes.end()) return;
  message = ranks.broadcast(message, static_cast<int>(first - codes.begin()));
  switch (*first) {
    case ExitCode::bad_input:
      throw InputError(message);
    case ExitCode::io_failed:
      throw IoError(message);
    default:
      throw SolverError(message);
  }
}

void do_on_root(const Communicator& ranks, const std::function<void()>& work) {
  do_together(ranks, [&] {
    if (ranks.is_root()) work();
  });
}

}  // namespace tailwater

// Work that may fail on some ranks, such as writing a file. If it does, all ranks fail with the same error.
#pragma once

#include <functional>

#include "parallel/communicator.h"

namespace tailwater {

/// Calls `work` on every rank. The call is collective; `work` need not be. When ranks throw a UserError, all ranks
/// throw that of the first of them, with the same type and message.
void do_together(const Communicator& ranks, const std::function<void()>& work);

/// Calls `work` on the root only; errors as above.
void do_on_root(const Communicator& ranks, const std::function<void()>& work);

}  // namespace tailwater

// Work that may fail on some ranks, such as writing a file: if it does, all ranks fail alike.
#pragma once

#include <functional>

#include "base/error.h"
#include "parallel/communicator.h"

namespace tailwater {

/// Does `work` on every rank; collective, `work` need not be. When a rank throws a UserError, all ranks throw that of
/// the first such rank: the same type, the same message.
void do_together(const Communicator& ranks, const std::function<void()>& work);

/// Does `work` on the root, as above.
void do_on_root(const Communicator& ranks, const std::function<void()>& work);

}  // namespace tailwater

#pragma once

namespace tailwater {

/// A package contains the program twice: as `bin/tailwater`, for any amd64 processor, and as
/// `lib/tailwater/tailwater-v3`, for those with AVX2. The first is replaced by the second where the processor allows
/// it; TAILWATER_ARCH in the environment chooses, x86-64-v2 or x86-64-v3. Returns where there is no second one, as in
/// every build that is not for a package.
void become_fastest_build(char** arguments);

}  // namespace tailwater

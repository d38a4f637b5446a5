#pragma once

namespace tailwater {

/// A package has the program twice: as `bin/tailwater`, for any amd64 processor, and as `lib/tailwater/tailwater-v3`,
/// for processors with AVX2. The first becomes the second where the processor allows it; TAILWATER_ARCH=x86-64-v2 in
/// the environment keeps the first. Returns where there is nothing faster. A program that is built for AVX2 ends with a
/// word where the processor has none.
void become_fastest_build(char** arguments);

}  // namespace tailwater

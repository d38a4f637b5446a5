#!/usr/bin/env bash
# Builds the program into build/<preset>/: build/<preset>/bin/tailwater. Usage: scripts/build.sh [preset] [--tests]
# With --tests the test programs too. Both have the same compiler flags, so one after the other compiles nothing again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
case ${2:-} in
  "") tests=OFF needed=(build) ;;
  --tests) tests=ON needed=(build gtest) ;;
  *) echo "build.sh: unknown option \"$2\"; there is --tests" >&2; exit 2 ;;
esac

scripts/install.sh "${needed[@]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset "$preset" -D TAILWATER_BUILD_TESTS=$tests >"$log" || { cat "$log" >&2; exit 1; }
cmake --build "build/$preset" --parallel

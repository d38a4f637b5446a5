#!/usr/bin/env bash
# Installs, builds and passes the tests. Usage: scripts/test.sh [preset] [ctest arguments]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
shift || true

if [[ $preset == asan ]]; then
  export LSAN_OPTIONS="suppressions=$PWD/tests/support/leaks.supp:print_suppressions=0"
  export UBSAN_OPTIONS="print_stacktrace=1"
  export TAILWATER_SLOWDOWN=10  # of a program with sanitizers, for tests that limit its CPU time
fi

# What only the running tests need is installed while the program compiles.
scripts/install.sh build gtest
{
  scripts/install.sh tests
  scripts/install.sh web || echo "test.sh: the page's tests will be skipped" >&2
} &
installing=$!
scripts/build.sh "$preset" --tests
wait $installing
# Ranks and the browser wait for each other a good part of the time: four tests at once fill two cores.
# Without arguments clang-tidy is left out: 90 s of CPU time that find no fault of the program (CONTRIBUTING.md).
[[ $# -gt 0 ]] || set -- --exclude-regex '^style\.tidy'
ctest --test-dir "build/$preset" --output-on-failure --parallel 4 "$@"

#!/usr/bin/env bash
# Installs, builds and passes the tests. Usage: scripts/test.sh [preset] [ctest arguments]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}
shift || true

scripts/install.sh build tests
scripts/build.sh "$preset" --tests
ctest --test-dir "build/$preset" --output-on-failure --parallel 2 "$@"

#!/usr/bin/env bash
# Builds into build/<preset>/; the program is build/<preset>/bin/tailwater. Usage: scripts/build.sh [preset]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${1:-release}

scripts/install.sh
cmake --preset "$preset" >"/tmp/tailwater-cmake-$preset.$$.log" || { cat "/tmp/tailwater-cmake-$preset.$$.log" >&2; exit 1; }
rm -f "/tmp/tailwater-cmake-$preset.$$.log"
cmake --build "build/$preset" --parallel

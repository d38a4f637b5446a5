#!/usr/bin/env bash
# Looks with libFuzzer for inputs that crash, hang or are refused without a place. Usage: scripts/fuzz.sh [target] [seconds]
# The targets are case, points, mesh, expression and checkpoint (tests/fuzz); without one all, a minute each. An input
# that finds something is kept in build/fuzz/findings/; mend what it shows, and put it into tests/fuzz/corpus/TARGET,
# where a test repeats it. What reaches new code is kept in build/fuzz/corpus/TARGET for the next time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
all=(case points mesh expression checkpoint)
seconds=${2:-60}
if (($# > 0)); then
  [[ " ${all[*]} " == *" $1 "* ]] || { echo "fuzz.sh: unknown target \"$1\"; there are: ${all[*]}" >&2; exit 2; }
  all=("$1")
fi

scripts/install.sh build tests fuzz
cmake --preset fuzz >/dev/null
cmake --build build/fuzz --parallel --target "${all[@]/#/fuzz_}"

mkdir -p build/fuzz/findings
for target in "${all[@]}"; do
  own=build/fuzz/corpus/$target
  mkdir -p "$own"
  echo "fuzz.sh: $target"
  build/fuzz/bin/fuzz_"$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=8192 \
    -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$target-" "$own" "tests/fuzz/corpus/$target" 2>&1 |
    grep -vE '^(#[0-9]+[[:space:]]+(NEW|REDUCE|RELOAD)|###|")'  # the first and the last line say what is covered
done

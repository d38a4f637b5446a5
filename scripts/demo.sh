#!/usr/bin/env bash
# Builds, runs the dam break of Zhou et al. (1999) at its own spacing (0.012 m), and compares it with the laboratory.
# Usage: scripts/demo.sh [--set KEY=VALUE]...   as in: scripts/demo.sh --set scheme.integrator=implicit
# Leaves out/demo/: the run; build/release/bin/tailwater view out/demo shows it with what was measured.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install.sh build
scripts/build.sh release
build/release/bin/tailwater run cases/zhou1999/case.toml --out out/demo --force "$@"
echo
build/release/bin/tailwater info out/demo

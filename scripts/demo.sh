#!/usr/bin/env bash
# Builds, runs the dam break of Zhou et al. (1999) at its own spacing (0.012 m), and compares it with the laboratory.
# Usage: scripts/demo.sh [--set KEY=VALUE]...   as in: scripts/demo.sh --set scheme.integrator=implicit
# Leaves out/demo/: the run, comparison.json and the picture zhou1999.png.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install.sh build pictures
scripts/build.sh release
build/release/bin/tailwater run cases/zhou1999/case.toml --out out/demo --force "$@"
echo
PYTHONPATH=validation:python /usr/bin/python3 -B -m tailwater_validation.compare zhou1999 out/demo

#!/usr/bin/env bash
# Installs what Tailwater needs from Debian 12's own packages. Safe to run again: what is there is left alone.
# Usage: scripts/install.sh [build] [tests] [pictures] [benchmarks] [site] [fuzz]   default: all but site, fuzz
set -euo pipefail

build=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libpetsc-real-dev libhdf5-openmpi-dev libopenmpi-dev openmpi-bin libtrilinos-zoltan-dev
  libeigen3-dev libcli11-dev libtomlplusplus-dev libmuparser-dev libfmt-dev nlohmann-json3-dev zlib1g-dev
)
pictures=(python3 python3-numpy python3-matplotlib python3-pil python3-vtk9 xvfb)
benchmarks=(libbenchmark-dev "${pictures[@]}")
fuzz=(clang-14 libclang-rt-14-dev)  # libFuzzer, for scripts/fuzz.sh
site=(mkdocs mkdocs-material mkdocs-material-extensions python3-pymdownx python3-yaml libjs-katex)  # scripts/site.py
tests=(libgtest-dev clang-format clang-tidy "${pictures[@]}" "${site[@]}")

(($# > 0)) || set -- build tests pictures benchmarks
wanted=()
for group in "$@"; do
  case $group in
    build) wanted+=("${build[@]}") ;;
    tests) wanted+=("${tests[@]}") ;;
    pictures) wanted+=("${pictures[@]}") ;;
    benchmarks) wanted+=("${benchmarks[@]}") ;;
    site) wanted+=("${site[@]}") ;;
    fuzz) wanted+=("${fuzz[@]}") ;;
    *) echo "install.sh: unknown group \"$group\"; there are: build, tests, pictures, benchmarks, site, fuzz" >&2; exit 2 ;;
  esac
done
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || {
    echo "install.sh: run as root or install sudo; missing packages: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "install.sh: installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null

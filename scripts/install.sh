#!/usr/bin/env bash
# Installs what Tailwater needs from Debian 12's own packages. Safe to run again: what is there is left alone.
# Usage: scripts/install.sh [build] [gtest] [tests] [pictures] [benchmarks] [web] [site] [package] [fuzz]   default: all but the last three
set -euo pipefail

build=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libpetsc-real-dev libhdf5-openmpi-dev libopenmpi-dev openmpi-bin libtrilinos-zoltan-dev
  libeigen3-dev libcli11-dev libtomlplusplus-dev libmuparser-dev libfmt-dev nlohmann-json3-dev zlib1g-dev
  libcpp-httplib-dev libdeflate-dev
  python3-dev pybind11-dev python3-numpy python3-pandas
)
gtest=(libgtest-dev)  # what compiles only with the tests
pictures=(python3 python3-numpy python3-matplotlib python3-pil python3-vtk9 xvfb)
benchmarks=(libbenchmark-dev "${pictures[@]}")
web=(chromium-headless-shell)  # for the tests of the page; what builds it is Node, below
fuzz=(clang-14 libclang-rt-14-dev)  # libFuzzer, for scripts/fuzz.sh
package=(dpkg-dev lintian debootstrap)  # scripts/package.sh
site=(mkdocs mkdocs-material mkdocs-material-extensions python3-pymdownx python3-yaml libjs-katex)  # scripts/site.py
tests=("${gtest[@]}" clang-format clang-tidy python3-jsonschema python3-rasterio python3-h5py python3-scipy "${pictures[@]}" "${site[@]}")

# The page is built by the Node that is there, else by Debian's. Debian's npm does not install beside a newer Node, which
# brings its own.
if ! command -v node >/dev/null; then
  web+=(nodejs npm)
elif ! command -v npm >/dev/null && [[ $(dpkg-query -W -f='${Version}' nodejs 2>/dev/null) == *dfsg* ]]; then
  web+=(npm)
fi

(($# > 0)) || set -- build tests pictures benchmarks web
wanted=()
for group in "$@"; do
  case $group in
    build) wanted+=("${build[@]}") ;;
    gtest) wanted+=("${gtest[@]}") ;;
    tests) wanted+=("${tests[@]}") ;;
    pictures) wanted+=("${pictures[@]}") ;;
    benchmarks) wanted+=("${benchmarks[@]}") ;;
    web) wanted+=("${web[@]}"); page=yes ;;
    site) wanted+=("${site[@]}") ;;
    package) wanted+=("${package[@]}") ;;
    fuzz) wanted+=("${fuzz[@]}") ;;
    *) echo "install.sh: unknown group \"$group\"; there are: build, gtest, tests, pictures, benchmarks, web, site, package, fuzz" >&2; exit 2 ;;
  esac
done
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [[ $status == "install ok installed" ]] || missing+=("$package")
done

install_missing() {
  ((${#missing[@]} > 0)) || return 0
  local as_root=()
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
}

# What web/package-lock.json names, as it names it.
install_page() {
  cd "$(dirname "${BASH_SOURCE[0]}")/../web"
  [[ node_modules/.package-lock.json -nt package-lock.json ]] && return 0
  command -v npm >/dev/null || {
    echo "install.sh: this Node has no npm; remedy: install the npm that belongs to it, or remove it for Debian's" >&2
    exit 1
  }
  echo "install.sh: installing what web/package-lock.json names" >&2
  npm ci --silent
}

install_missing
[[ -z ${page:-} ]] || install_page

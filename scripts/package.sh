#!/usr/bin/env bash
# Makes the Debian packages: build/package/tailwater_VERSION_amd64.deb, python3-tailwater,
# libtailwater-dev and tailwater-doc. The program is in the first twice, for any amd64 processor and for those with AVX2. Usage: scripts/package.sh [--check]
# --check: also lintian, and a trial of the installed packages in a Debian root made by debootstrap (as root).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/install.sh build site package
version=$(sed -nE 's/^project\(tailwater VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)

files=build/debian-files
mkdir -p "$files"
{
  cat <<'TEXT'
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: tailwater

Files: *
Copyright: 2026 The Tailwater developers
License: Apache-2.0
 On Debian systems the text of the Apache License 2.0 is in
 /usr/share/common-licenses/Apache-2.0.

Files: cases/*/data/*
Copyright: the authors named at the head of each file
License: measurements
 Numbers measured and published by others, with their source at the head of each
 file; see NOTICE.

Files: html/*
Copyright: 2013-2020 Khan Academy and other contributors (KaTeX)
 2016-2022 Martin Donath (Material for MkDocs)
License: Expat

Files: web/dist/view.html
Copyright: the authors of its libraries, named in the licence
License: Expat
TEXT
  sed -e 's/^$/./' -e 's/^/ /' web/dist/licences.txt
} >"$files/copyright"
{
  echo "tailwater ($version) unstable; urgency=low"
  echo
  echo "  * See CHANGELOG.md."
  echo
  echo " -- The Tailwater developers <maintainers@tailwater.example>  $(date -R -d "@$(git log -1 --format=%ct)")"
} | gzip -9n >"$files/changelog.gz"

configure() {  # NAME ARCH [cmake arguments]
  cmake -S . -B "build/package-$1" -G Ninja -D CMAKE_BUILD_TYPE=Release -D TAILWATER_BUILD_TESTS=OFF -D TAILWATER_ARCH="$2" \
    -D TAILWATER_PYTHON=ON -D CMAKE_DISABLE_FIND_PACKAGE_benchmark=ON -D CMAKE_INSTALL_PREFIX=/usr "${@:3}" >/dev/null
}
scripts/site.py build/site
configure v3 x86-64-v3 -D CMAKE_BUILD_WITH_INSTALL_RPATH=ON  # as it is packed: CMake takes no paths of libraries out
cmake --build build/package-v3 --target tailwater
strip -o "$files/tailwater-v3" build/package-v3/bin/tailwater
configure v2 x86-64-v2 -D TAILWATER_FASTER_PROGRAM="$PWD/$files/tailwater-v3" -D TAILWATER_DEBIAN_FILES="$PWD/$files" \
  -D TAILWATER_SITE="$PWD/build/site"
cmake --build build/package-v2
rm -rf build/package
mkdir -p build/package
(cd build/package-v2 && cpack -G DEB -B ../package >/dev/null)
rm -rf build/package/_CPack_Packages
ls -l build/package/*.deb

[[ ${1:-} == --check ]] || exit 0
lintian --fail-on error build/package/*.deb
packaging/try.sh build/package

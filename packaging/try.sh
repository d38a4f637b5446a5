#!/usr/bin/env bash
# Tries the packages in DIR on a bare Debian 12: a root made by debootstrap, in which apt installs them and a user makes,
# runs, draws, shows and validates a case; makes mistakes; draws in 3D without VTK and with it; and runs the program on a
# processor without AVX2, which QEMU is. Tells what the time to the first picture goes into, and fails if that is more than
# 3 minutes. As root. Usage: packaging/try.sh DIR [ROOT]
# ROOT: a bare root that debootstrap has made before; it is used up. The root is as Debian's container image in that dpkg
# does not wait for the disk after each file, which takes more than half of the time of an installation.
set -euo pipefail
packages=$(realpath "$1")
root=${2:-$(mktemp -d)}
chmod 755 "$root"  # a user has to get in
trap 'umount "$root"/{proc,sys,dev/pts,dev/shm} 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
if (($# < 2)); then
  echo "try.sh: making a bare Debian 12"
  debootstrap --variant=minbase bookworm "$root" >/dev/null
fi
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/container"
cp "$packages"/tailwater_*_amd64.deb "$packages"/python3-tailwater_*_amd64.deb "$root/"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"  # where Open MPI looks for the processors
mount -t tmpfs -o mode=1777 shm "$root/dev/shm"  # and where its ranks meet
mount -t devpts devpts "$root/dev/pts"
in_root() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 sh -ec "$1"; }
install() { in_root "DEBIAN_FRONTEND=noninteractive apt-get install -y -qq $1 >/dev/null"; }
user() { in_root "su engineer -c 'cd && $1'"; }
refused() {  # COMMAND WORDS: the command must end with 2 and say this in one line
  local told
  told=$(user "$1" 2>&1 >/dev/null) && { echo "try.sh: not refused: $1" >&2; exit 1; }
  [[ $told == error:*$2* && $(wc -l <<<"$told") == 1 ]] || { echo "try.sh: $1: $told" >&2; exit 1; }
}

start=$SECONDS
TIMEFORMAT="try.sh: %R s, of the processor %U + %S s"
echo "apt update"
time in_root 'apt-get update -qq'
echo "download"
time install '--download-only /tailwater_*_amd64.deb'
echo "unpack and configure"
time install '/tailwater_*_amd64.deb'
in_root 'useradd --create-home engineer
  echo "try.sh: $(dpkg-query -W | wc -l) packages, $(du -sm /usr | cut -f1) MB in /usr, $(du -sm /var/cache/apt/archives | cut -f1) MB of archives"'
user 'tailwater info && tailwater new dam-break my.toml && tailwater check my.toml && tailwater run my.toml --out my_run \
  --quiet --pictures 1 --set particles.spacing=0.04 && ls my_run/pictures'
first=$((SECONDS - start))
echo "try.sh: first picture after $first s"

user 'tailwater view my_run --export my_run.html && grep -q tailwater-data my_run.html'
user 'tailwater run /usr/share/tailwater/cases/zhou1999/case.toml --out zhou --quiet --set particles.spacing=0.06 -n 2'
user 'tailwater export my_run --netcdf gauges.nc --paraview state.py && ls -l gauges.nc'
user 'tailwater validate --list && tailwater validate poiseuille ritter --level quick --out report'
user 'tailwater man | head -1 && test -s /usr/share/tailwater/case.schema.json && test -s /usr/share/man/man1/tailwater.1.gz'

refused 'tailwater run my.toml --out my_run' 'my_run'
refused 'tailwater check my.toml --set particles.spacing=-1' 'out of range'
refused 'tailwater pictures nowhere' 'is not the folder of a run'
refused 'TAILWATER_ARCH=native tailwater info' 'x86-64-v3'

user 'tailwater new pier pier.toml && tailwater check pier.toml --set particles.spacing=0.06 2>told; cat told;
  test $(wc -l <told) = 1 && grep -q "apt install python3-vtk9 xvfb" told'
user 'tailwater run pier.toml --out pier --quiet --set particles.spacing=0.06 --set time.end=0.02'
refused 'tailwater pictures pier' 'apt install python3-vtk9 xvfb'
install '--no-install-recommends python3-vtk9 xvfb python3-h5py'
user 'tailwater pictures pier --count 1 && ls pier/pictures && tailwater export pier --vtkhdf water.vtkhdf'

install '--no-install-recommends /python3-tailwater_*_amd64.deb qemu-user'
user 'python3 -c "import tailwater as tw; print(next(iter(tw.Case.template(\"tank\").simulation())))"'
user 'tailwater info | grep "ARCH x86-64-v3" && TAILWATER_ARCH=x86-64-v2 tailwater info | grep "ARCH x86-64-v2"'
user 'TAILWATER_ARCH=x86-64-v2 tailwater run my.toml --out on_any --quiet --set particles.spacing=0.04 --set time.end=0.2'
# Of 2010: SSE4.2, no AVX.
user 'qemu-x86_64 -cpu Westmere /usr/bin/tailwater run my.toml --out on_old --quiet --set particles.spacing=0.08 \
  --set time.end=0.05 && grep "ARCH x86-64-v2" on_old/summary.json'
refused 'qemu-x86_64 -cpu Westmere /usr/lib/tailwater/tailwater-v3 info' 'AVX2'
user 'qemu-x86_64 -cpu Westmere /usr/bin/python3 -c "import tailwater as tw
print(next(iter(tw.Case.template(\"tank\").simulation())))"'
echo "try.sh: all of it passed"
((first <= 180)) || { echo "try.sh: the first picture takes longer than 3 minutes" >&2; exit 1; }

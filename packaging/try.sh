#!/usr/bin/env bash
# Tries the packages in DIR on a bare Debian 12: a root made by debootstrap, in which apt installs them and a user makes,
# runs, draws, shows and validates a case, with the program for all processors too. Tells the time to the first picture
# and fails if that is more than 3 minutes. As root. Usage: packaging/try.sh DIR [ROOT]
# ROOT: a bare root that debootstrap has made before; it is used up. The root is as Debian's container image in that dpkg
# does not wait for the disk after each file, which takes more than half of the time of an installation.
set -euo pipefail
packages=$(realpath "$1")
root=${2:-$(mktemp -d)}
trap 'umount "$root/proc" "$root/sys" 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
if (($# < 2)); then
  echo "try.sh: making a bare Debian 12"
  debootstrap --variant=minbase bookworm "$root" >/dev/null
fi
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/container"
cp "$packages"/tailwater_*_amd64.deb "$packages"/python3-tailwater_*_amd64.deb "$root/"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"  # where Open MPI looks for the processors
in_root() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 sh -ec "$1"; }

start=$SECONDS
TIMEFORMAT="try.sh: apt took %R s, of the processor %U + %S s"
time in_root '
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq /tailwater_*_amd64.deb >/dev/null
  useradd --create-home engineer
'
user() { in_root "su engineer -c 'cd && $1'"; }
user 'tailwater info && tailwater new dam-break my.toml && tailwater check my.toml && tailwater run my.toml --out my_run \
  --quiet --pictures 1 --set particles.spacing=0.04 && ls my_run/pictures'
first=$((SECONDS - start))
echo "try.sh: first picture after $first s"
user 'tailwater view my_run --export my_run.html && grep -q tailwater-data my_run.html'
user 'tailwater run /usr/share/tailwater/cases/zhou1999/case.toml --out zhou --quiet --set particles.spacing=0.06'
user 'tailwater export my_run --netcdf gauges.nc --vtkhdf water.vtkhdf --paraview state.py && ls -l gauges.nc water.vtkhdf'
user 'tailwater validate --list && tailwater validate poiseuille ritter --level quick --out report'
in_root 'DEBIAN_FRONTEND=noninteractive apt-get install -y -qq /python3-tailwater_*_amd64.deb >/dev/null'
user 'python3 -c "import tailwater as tw; print(next(iter(tw.Case.template(\"tank\").simulation())))"'
user 'tailwater man | head -1 && test -s /usr/share/tailwater/case.schema.json'
user 'TAILWATER_ARCH=x86-64-v2 tailwater info | grep "ARCH x86-64-v2" && TAILWATER_ARCH=x86-64-v2 tailwater run my.toml \
  --out on_any --quiet --set particles.spacing=0.04 --set time.end=0.2'
((first <= 180)) || { echo "try.sh: the first picture takes longer than 3 minutes" >&2; exit 1; }

#!/usr/bin/env bash
# Tries the packages in DIR on a bare Debian 12: a root made by debootstrap, in which apt installs them and the program
# makes, runs and draws a case. As root. Usage: packaging/try.sh DIR
set -euo pipefail
packages=$(realpath "$1")
root=$(mktemp -d)
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$root"' EXIT
debootstrap --variant=minbase bookworm "$root" >/dev/null
cp "$packages"/tailwater_*_amd64.deb "$root/"
cp /etc/apt/sources.list "$root/etc/apt/" 2>/dev/null || true
cp -r /etc/apt/sources.list.d /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
mount -t proc proc "$root/proc"
start=$SECONDS
chroot "$root" sh -ec '
  apt-get update -qq
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq ./tailwater_*_amd64.deb >/dev/null
  cd /root
  tailwater info
  tailwater new dam-break my.toml
  tailwater check my.toml
  tailwater run my.toml --out my_run --set particles.spacing=0.05 --set time.end=0.5
  TAILWATER_ARCH=x86-64-v2 tailwater run my.toml --out my_old_run --set particles.spacing=0.05 --set time.end=0.2
  tailwater pictures my_run
  ls my_run/pictures
  tailwater validate --list >/dev/null
'
echo "try.sh: installed, ran and drew in $((SECONDS - start)) s"

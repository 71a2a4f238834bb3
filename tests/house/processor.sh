#!/usr/bin/env bash
# On a processor without AVX2 the program says so in one sentence: processor.sh PROGRAM ARCH (the value of -march).
set -euo pipefail
program=$1
arch=$2
if ! command -v qemu-x86_64 >/dev/null; then
  echo "skipped: an emulated processor is missing (Debian: apt-get install qemu-user)"
  exit 77
fi
status=0
said=$(qemu-x86_64 -cpu Nehalem "$program" --version 2>&1) || status=$?
if [ "$arch" = x86-64-v3 ]; then
  [ "$status" -eq 1 ] && [ "$(wc -l <<<"$said")" -eq 1 ] && grep -q '^tanktread: .*lacks AVX, AVX2, BMI2, FMA (' <<<"$said"
else
  [ "$status" -eq 0 ]
fi || {
  echo "on a Nehalem, status $status: $said" >&2
  exit 1
}

#!/usr/bin/env bash
# One fuzz target with its corpus: fuzz.sh PROGRAM CORPUS [libFuzzer options]. The corpus itself is not changed; no input may
# take longer than 10 s or the process more than 1 GiB. An input that fails is left in the present folder.
set -euo pipefail
program=$1
corpus=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work" /tmp/tanktread-fuzz-pipe' EXIT
log=$work/log
if "$program" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=512 -print_final_stats=1 "$@" "$work" "$corpus" >"$log" 2>&1; then
  grep -E '^Done|stat::(number_of_executed|peak_rss)' "$log"
else
  tail -n 60 "$log"
  exit 1
fi

#!/usr/bin/env bash
# Draws our own expected pictures again and compares them as a user would: goldens.sh PROGRAM TEST_RENDER MADE GOLDENS REPORT.
set -euo pipefail
program=$1
drawer=$2
made=$3
goldens=$4
report=$5

rm -rf "$made" "$report"
TANKTREAD_GOLDENS_MADE=$made "$drawer" -# '[#test_goldens]' >/dev/null || true  # it judges, too; here it only draws
"$program" compare "$goldens" "$made" --html "$report" || {
  status=$?
  echo "look at $report/index.html" >&2
  exit "$status"
}

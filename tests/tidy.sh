#!/usr/bin/env bash
# clang-tidy over sim, render and app by .clang-tidy: tests/tidy.sh [REGEX of files]. Some ten minutes on two cores, so it is
# no part of the tests. Status 1 when it finds something.
set -euo pipefail
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/tidy
command -v run-clang-tidy >/dev/null || { echo "tidy.sh: this needs clang-tidy (run-clang-tidy)" >&2; exit 1; }
# GCC's precompiled headers mean nothing to clang.
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
      -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
run-clang-tidy -quiet -p "$build" "${1:-$root/(sim|render|app)/.*\.cpp}" 2>/dev/null

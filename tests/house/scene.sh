#!/usr/bin/env bash
# A scene, shortened, through the whole chain: scene.sh PROGRAM SCENE.
set -euo pipefail
program=$1
scene=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "$scene: $1" >&2
  exit 1
}

"$program" run "$scene" -o "$folder/dry" --dry-run >"$folder/resolved.toml"
[ ! -e "$folder/dry" ] || fail "--dry-run left something behind"
"$program" run "$folder/resolved.toml" -o "$folder/dry" --dry-run >"$folder/again.toml"
cmp -s "$folder/resolved.toml" "$folder/again.toml" || fail "the resolved scene does not resolve to itself"

shorten=(--steps 3 --set 'view.size=[160, 90]')
"$program" run "$scene" -o "$folder/out" "${shorten[@]}" >"$folder/log"
for name in trajectory.h5 scene.toml frames/000000.png; do
  [ -s "$folder/out/$name" ] || fail "there is no $name"
done
if command -v ffmpeg >/dev/null; then
  [ -s "$folder/out/movie.mp4" ] || fail "there is no movie.mp4"
fi
[ -z "$(find "$folder/out" -name '*.tmp' -o -name '*.lock')" ] || fail "something half-written was left behind"
"$program" info "$folder/out/trajectory.h5" | grep '^states' >/dev/null || fail "info does not tell the states"
"$program" export "$folder/out/trajectory.h5" --csv - | sed -n 1p | grep '^step,time,vesicle,area,' >/dev/null || fail "export"

"$program" run "$scene" -o "$folder/out" "${shorten[@]}" >"$folder/log"
grep -q ' 0 frames drawn' "$folder/log" || fail "a second run drew frames again"

# To its end, where that takes seconds.
vesicles=$("$program" info "$folder/out/trajectory.h5" | sed -n 's/^vesicles *\([0-9]*\),.*/\1/p')
if [ "$vesicles" -le 2 ]; then
  "$program" simulate "$scene" -o "$folder/whole.h5" >"$folder/log" || fail "the whole run ends before its time"
fi

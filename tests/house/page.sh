#!/usr/bin/env bash
# The page of `export --html` in a browser without a window, beside the program's own picture of the same state and
# camera: page.sh PROGRAM SCENE. Skipped (77) where there is no Chromium.
set -euo pipefail
program=$1
scene=$2
browse=$(dirname -- "${BASH_SOURCE[0]}")/browse.py
command -v chromium chromium-browser google-chrome >/dev/null || exit 77

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" simulate "$scene" --set time.end=2 --set time.save_every=1 --set vesicle.order=10 -q -o "$folder/t.h5"
nothing_over=(--set view.time_stamp=false --set view.caption=false --set view.scale_bar=false --set view.colour_bar=false)
# Page and picture of the same settings: alike FILE WORD OPTIONS..., with the tolerances TOLERANCES.
alike() {
  local trajectory=$1 words=$2
  shift 2
  "$program" export "$trajectory" --html "$folder/page.html" "${nothing_over[@]}" "$@" -q
  "$program" render "$trajectory" --time 2 --size 640x360 "${nothing_over[@]}" "$@" -q -o "$folder/own.png" --gl software
  "$browse" "file://$folder/page.html#frame=2&bare$words" 640x360 shot "$folder/page.png"
  "$program" compare "$folder/own.png" "$folder/page.png" --largest 255 --rmse 5 "${tolerances[@]}"
}

# Browsers average samples in sRGB, not in linear light: edges and thin lines are a shade darker. A line that is
# missing, a light that has moved or a vesicle half a pixel off is beyond these.
tolerances=(--channel 24 --share 0.02)
for style in opaque ghost field cutaway; do
  alike "$folder/t.h5" "&style=$style" --set view.camera=three-quarter --set view.style=$style
done
# Small vesicles, with fewer lines, among arrows, rings of arrows seen end-on, and the edges of a cell: an arrow has some
# 150 pixels.
tolerances=(--channel 48 --share 0.0003)
alike "$folder/t.h5" "" --set view.zoom=0.3
alike "$folder/t.h5" "" --set view.zoom=0.3 --set view.camera=along-flow
"$program" simulate "$scene" --set time.end=2 --set time.save_every=1 --set vesicle.order=6 --set 'cell.size=[5, 5, 5]' -q \
  -o "$folder/cell.h5"
alike "$folder/cell.h5" "" --set view.zoom=0.5 --set view.camera=three-quarter

# One plane opens both of a pair of unlike vesicles, where a movie has it: across their long axis, so that half a pixel
# aside another one would show.
"$program" simulate "$(dirname -- "$scene")/encounter.toml" --set time.end=2 --set time.save_every=1 --set 'vesicle.0.radius=0.7' \
  --set 'vesicle.0.center=[-2, 0, 0.4]' --set 'vesicle.1.center=[1.5, 0, -0.4]' -q -o "$folder/pair.h5"
tolerances=(--channel 24 --share 0.02)
alike "$folder/pair.h5" "&style=cutaway" --set view.camera=three-quarter --set view.style=cutaway --set view.cut=common \
  --set 'view.cut_normal=[-0.3, -1, 0.2]'

# The section in the inset has the area of the figure of cross-sections.
"$program" export "$folder/t.h5" --html "$folder/page.html" --set view.inset=true -q
"$program" figure cross-sections "$folder/t.h5" --set 'figure.times=[2]' -q -o "$folder/section"
cat >"$folder/area.js" <<'ENDJS'
(() => {
  const page = JSON.parse(document.getElementById("data").textContent), box = document.getElementById("inset").getBoundingClientRect();
  const points = document.querySelector("#inset path").getAttribute("d").match(/[-.\d]+ [-.\d]+/g).map(pair => pair.split(" ").map(Number));
  let twice = 0;
  points.forEach(([x, y], k) => { const [u, v] = points[(k + 1) % points.length]; twice += x * v - u * y; });
  return Math.abs(twice) / 2 * (2 * page.inset.half_height / box.height) ** 2;
})()
ENDJS
shown=$("$browse" "file://$folder/page.html#frame=2" 1440x900 ask "$folder/area.js")
python3 - "$folder/section.csv" "$shown" <<'ENDPY'
import csv, sys
points = [(float(row["x"]), float(row["z"])) for row in csv.DictReader(open(sys.argv[1]))]
area = abs(sum(x * v - u * z for (x, z), (u, v) in zip(points, points[1:] + points[:1]))) / 2
# points of the inset are rounded to a tenth of a pixel of a box of some 190
assert abs(float(sys.argv[2]) / area - 1) < 0.01, f"the inset's section has the area {sys.argv[2]}, the figure's {area}"
ENDPY

# On a screen and on a telephone: everything is in the window, no text lies on another, and fingers can hit the controls.
"$program" export "$folder/t.h5" --html "$folder/page.html" --set view.field=tension --set view.flow_profile=true --set view.inset=true -q
cat >"$folder/look.js" <<'EOF'
(() => {
  const faults = [], boxes = [], range = document.createRange();
  const add = (name, element, text) => {
    range.selectNodeContents(element);
    const { left, top, right, bottom } = (text ? range : element).getBoundingClientRect();
    if (right <= left || bottom <= top) return;
    if (left < 0 || top < 0 || right > innerWidth || bottom > innerHeight) faults.push(`${name} is cut`);
    for (const other of boxes)
      if (left < other.right && other.left < right && top < other.bottom && other.top < bottom) faults.push(`${name} lies on ${other.name}`);
    boxes.push({ name, left, top, right, bottom });
  };
  for (const id of ["time", "parameters", "title"]) add(id, document.getElementById(id), true);
  add("scale", document.querySelector("#scale span"), true);
  for (const [k, part] of document.querySelectorAll("#bar figcaption, #bar i, #bar li").entries()) add(`part ${k} of the bar`, part, part.tagName !== "I");
  const profile = document.querySelector("#profile g");
  if (innerWidth > innerHeight !== profile.childElementCount > 0) faults.push("the profile is not in wide windows alone");
  add("profile", profile);
  const inset = document.getElementById("inset");
  if (getComputedStyle(inset).display === "none" && document.getElementById("keys").hidden) faults.push("the inset finds no place");
  add("inset", inset);
  if (!document.getElementById("keys").hidden) add("keys", document.getElementById("keys"));
  for (const control of document.querySelectorAll("button, select, #scrub")) {
    add(control.id, control);
    if (innerWidth < 500 && control.getBoundingClientRect().height < 44) faults.push(`${control.id} is too low for a finger`);
  }
  return faults.join(", ") || "none";
})()
EOF
for words in style=opaque style=field style=opaque\&keys style=field\&keys style=cutaway; do
  for window in 1440x900@1 390x844@3 844x390@3; do
    faults=$("$browse" "file://$folder/page.html#frame=2&$words" "$window" ask "$folder/look.js")
    [ "$faults" = none ] || { echo "$words at $window: $faults" >&2; exit 1; }
  done
done

#!/usr/bin/env bash
# The page of `export --html` in a browser without a window, beside the program's own picture of the same state and
# camera: page.sh PROGRAM SCENE. Skipped (77) where there is no Chromium.
set -euo pipefail
program=$1
scene=$2
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || exit 77

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" simulate "$scene" --set time.end=2 --set time.save_every=1 --set vesicle.order=10 -q -o "$folder/t.h5"
plain=(--set view.time_stamp=false --set view.caption=false --set view.scale_bar=false --set view.colour_bar=false
       --set view.camera=three-quarter --set view.flow_arrows=true)
"$program" export "$folder/t.h5" --html "$folder/page.html" "${plain[@]}" -q
for style in opaque ghost field; do
  "$program" render "$folder/t.h5" --time 2 --size 640x360 --style $style "${plain[@]}" -q -o "$folder/$style.png" \
    --gl software
  # The software OpenGL of the browser itself: what a machine without a screen has.
  timeout 100 "$browser" --headless=new --no-sandbox --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
    --user-data-dir="$folder/profile" --hide-scrollbars --window-size=640,360 --virtual-time-budget=5000 \
    --screenshot="$folder/page-$style.png" "file://$folder/page.html#frame=2&style=$style&bare" 2>"$folder/log" ||
    { cat "$folder/log" >&2; exit 1; }
  # Browsers average samples in sRGB, not in linear light: edges and thin lines are a shade darker. A line that is
  # missing, a light that has moved or a vesicle half a pixel off is beyond these.
  "$program" compare "$folder/$style.png" "$folder/page-$style.png" --channel 24 --share 0.02 --largest 255 --rmse 5
done

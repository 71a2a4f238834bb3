#!/usr/bin/env bash
# What docs/ci.md shows works from an empty folder: ci_page.sh PROGRAM PAGE.
set -euo pipefail
program=$1
page=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "$page: $1" >&2
  exit 1
}

# The first block sets everything up and accepts the first pictures.
awk '/^```sh$/ { if (++block == 1) { inside = 1; next } } /^```$/ { inside = 0 } inside' "$page" >setup.sh
mkdir bin project
ln -s "$program" bin/tanktread
export PATH=$folder/bin:$PATH
cd project
bash -e ../setup.sh >../log || fail "the example does not run"
grep -q 'expected/000002.png added' ../log || fail "the first pictures were not accepted"
./check-pictures.sh >../log || fail "a second drawing is not the same"
grep -q '^3 pictures: 3 same$' ../log || fail "there are not three pictures"
[ -s report/index.html ] && grep -q 'failures="0" errors="0"' report/pictures.xml || fail "there is no report"
sed -i 's/^reduced_volume = 0.9$/reduced_volume = 0.89/' scene.toml
status=0
./check-pictures.sh >../log || status=$?
[ "$status" -eq 1 ] || fail "another shape gave status $status instead of 1"
grep -q 'failures="3" errors="0"' report/pictures.xml || fail "the JUnit report does not tell the failures"
grep -q 'data:image/png;base64' report/index.html || fail "the page has no pictures"
# No pictures, no answer.
echo 'reduced_volume = "much"' >>scene.toml
status=0
./check-pictures.sh >../log 2>&1 || status=$?
[ "$status" -eq 2 ] || fail "a scene that cannot be read gave status $status instead of 2"

#!/usr/bin/env bash
# `cmake --install` puts everything below DESTDIR and the prefix, and it works wherever it is moved: install.sh CMAKE BUILD.
set -euo pipefail
cmake=$1
build=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
  echo "cmake --install: $1" >&2
  exit 1
}

DESTDIR=$folder/stage "$cmake" --install "$build" --prefix /opt/tank >"$folder/log"
[ "$(ls -A "$folder/stage")" = opt ] || fail "files lie outside the prefix"
mv "$folder/stage/opt/tank" "$folder/elsewhere"
cd "$folder/elsewhere"
for file in bin/tanktread share/man/man1/tanktread.1 share/bash-completion/completions/tanktread \
            share/tanktread/scenes/tank-treading.toml share/doc/tanktread/README.md share/doc/tanktread/LICENSE \
            share/doc/tanktread/docs/reference.md share/doc/tanktread/docs/licences.md; do
  [ -s "$file" ] || fail "there is no $file"
done
# Every link of the documents leads to something that is installed.
grep -rhoE '\]\([^)# ]+' --include=README.md share/doc/tanktread | sed 's/^](//' | grep -v '^https\{0,1\}:' | while read -r link; do
  [ -e "share/doc/tanktread/$link" ] || fail "README.md leads to $link, which is not installed"
done
bin/tanktread simulate share/tanktread/scenes/tank-treading.toml --steps 1 -q -o "$folder/t.h5" || fail "the program does not run"
[ -s "$folder/t.h5" ] || fail "the program wrote nothing"
if command -v groff >/dev/null; then
  groff -man -Tutf8 -K utf8 -ww share/man/man1/tanktread.1 2>"$folder/warnings" >"$folder/page" || fail "groff cannot read the manual page"
  [ ! -s "$folder/warnings" ] || fail "groff says of the manual page: $(head -n 1 "$folder/warnings")"
fi

#!/usr/bin/env bash
# Which packages tanktread.sh asks for, on systems that are only told of: script.sh TANKTREAD.SH.
set -euo pipefail
script=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/bin" "$folder/clone/build/release"
cp "$script" "$folder/clone/tanktread.sh"
cd "$folder"

fail() {
  echo "tanktread.sh: $1" >&2
  cat calls said >&2
  exit 1
}

# tool NAME: a program of that name that does what standard input says.
tool() {
  { echo '#!/bin/sh'; cat; } >"bin/$1"
  chmod +x "bin/$1"
}

tool id <<<'echo 0'
tool cmake <<<"echo cmake \"\$@\" >>$folder/calls"
tool ctest <<<"echo ctest >>$folder/calls"
tool dpkg-query <<END
for name in "\$@"; do :; done
if grep -qx "\$name" $folder/installed; then printf installed; else exit 1; fi
END
tool apt-cache <<END
echo "\$2:"
if grep -qx "\$2" $folder/offered; then echo '  Candidate: 1.0'; else echo '  Candidate: (none)'; fi
END
tool apt-get <<END
echo apt-get "\$@" >>$folder/calls
case \$1 in
  update) [ -e $folder/archive ] && cp $folder/archive $folder/offered ;;
  install) shift; for name in "\$@"; do echo "\$name" >>$folder/installed; done ;;
esac
END
printf '#!/bin/sh\necho started >>%s/calls\n' "$folder" >clone/build/release/tanktread
chmod +x clone/build/release/tanktread

# system WORDS...: a bare one whose archive offers what the script names in any way, but not WORDS.
system() {
  sed -n '/^packages=(/,/^usage/p' "$script" | grep -v '^#' | grep -oE '[a-z][a-z0-9+-]+' | sort -u >archive
  local word
  for word in "$@"; do sed -i "/^$word\$/d" archive; done
  : >offered
  : >installed
}

# go ARGUMENTS...: the script, on that system.
go() {
  : >calls
  status=0
  PATH=$folder/bin:$PATH clone/tanktread.sh "$@" >said 2>&1 || status=$?
}
installs() { sed -n 's/^apt-get install -y -q --no-install-recommends/&/p' calls | tr ' ' '\n' | grep -qx -- "$1"; }

system
go run x.toml
[ "$status" -eq 0 ] && grep -qx started calls || fail "run does not come to the program"
installs libosmesa6 && ! installs libegl1 || fail "run does not take the first of two that serve"
! installs catch2 && ! installs python3 && ! installs clang || fail "run installs what only tests need"
grep -q 'cmake --preset release -DBUILD_TESTING=OFF' calls || fail "run configures the tests"
go run x.toml
! grep -q apt-get calls || fail "run asks again for what is installed"
go test
[ "$status" -eq 0 ] && grep -qx ctest calls || fail "test does not come to the tests"
installs catch2 && installs clang && installs libegl1 && ! installs g++ || fail "test does not install what is missing"
grep -q 'cmake --preset release -DBUILD_TESTING=ON' calls || fail "test does not configure the tests"

system libosmesa6 python3-vtk9
go test
installs libegl1 && installs libgl1-mesa-dri && ! installs libosmesa6 || fail "the second of two is not taken"
grep -q 'tests that need these packages are skipped: python3-vtk9' said || fail "nothing is said of what some tests lack"
go test
[ "$status" -eq 0 ] && ! grep -q apt-get calls || fail "what no system offers is asked for again and again"

system
go run x.toml
rm archive
go test
[ "$status" -eq 1 ] || fail "without a network the tests cannot be built, and nothing says so"
printf 'catch2\npython3\n' >>installed
go test
[ "$status" -eq 0 ] && grep -qx ctest calls || fail "without a network what some tests lack stops all"

system libfftw3-dev
go run x.toml
[ "$status" -eq 1 ] && grep -qx 'tanktread.sh: this system does not offer the package libfftw3-dev, which is needed' said ||
  fail "a package that is needed and not offered is not named"
! grep -q 'apt-get install' calls || fail "something is installed although the program cannot be built"

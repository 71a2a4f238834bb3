#!/usr/bin/env bash
# The README's two commands on bare systems, then the package in another bare one: tests/distributions.sh [SUITE...]
# Suites are Debian's (bookworm trixie forky when none is given). Needs root, debootstrap, some 10 GB and an hour or two; no
# part of CI. Prints one Markdown table, that of docs/systems.md; everything else goes to the logs.
#   TANKTREAD_SYSTEMS   where systems and logs are kept (default /var/tmp/tanktread-systems); remove it when done
#   DEBIAN_MIRROR       where packages come from (default: what apt of this machine is set to, or deb.debian.org)
#   TANKTREAD_CCACHE    a folder for ccache, which is then installed besides (default: none, so that systems stay bare)
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
systems=${TANKTREAD_SYSTEMS:-/var/tmp/tanktread-systems}
cache=${TANKTREAD_CCACHE:-}
mirror=${DEBIAN_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' 2>/dev/null | head -n 1)}
mirror=${mirror:-http://deb.debian.org/debian}
[ $# -gt 0 ] || set -- bookworm trixie forky
if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "distributions.sh: this needs root and debootstrap" >&2
  exit 1
fi
mkdir -p "$systems"

# bare SUITE FOLDER: a new system; debootstrap works once a suite.
bare() {
  local suite=$1 folder=$2 script=/usr/share/debootstrap/scripts/$1
  if [ ! -f "$systems/$suite.tar" ]; then
    [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
    rm -rf --one-file-system "$folder"
    debootstrap --variant=minbase "$suite" "$folder" "$mirror" "$script"
    tar -C "$folder" -cf "$systems/$suite.tar.tmp" .
    mv "$systems/$suite.tar.tmp" "$systems/$suite.tar"
  fi
  rm -rf --one-file-system "$folder"
  mkdir "$folder"
  tar -C "$folder" -xf "$systems/$suite.tar"
  cp /etc/resolv.conf "$folder/etc/resolv.conf"
  # The signatures of testing hold for a week, and not every mirror keeps up with that.
  echo 'Acquire::Check-Valid-Until "false";' >"$folder/etc/apt/apt.conf.d/90mirror"
}

# inside FOLDER COMMAND: by sh in the system, with mounts and processes of its own that end with it.
inside() {
  local folder=$1
  mkdir -p "$folder/root/.ccache"
  # shellcheck disable=SC2016
  CACHE=$cache unshare --mount --pid --fork sh -ec '
    mount --make-rprivate /
    mount -t proc proc "$1/proc"
    mount --rbind /dev "$1/dev"
    [ -z "$CACHE" ] || mount --bind "$CACHE" "$1/root/.ccache"
    exec chroot "$1" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
         ${http_proxy:+http_proxy=$http_proxy} sh -ec "$2"' sh "$folder" "$2"
}

# timed LOG FOLDER COMMAND: prints "ok, 5 min 10 s" or "FAILED (status 1), ...".
timed() {
  local log=$1 start=$SECONDS status=0 result=ok took
  inside "$2" "$3" >"$log" 2>&1 </dev/null || status=$?
  [ "$status" -eq 0 ] || result="FAILED (status $status)"
  took=$((SECONDS - start))
  echo "$result, $((took / 60)) min $((took % 60)) s"
}

# version FOLDER PACKAGE...: of the first that is installed.
version() {
  local folder=$1 package found
  shift
  for package in "$@"; do
    found=$(chroot "$folder" dpkg-query -W -f='${db:Status-Status} ${Version}\n' "$package" 2>/dev/null |
            sed -n 's/^installed \([0-9]*:\)\{0,1\}\([^-+~]*\).*/\2/p' | head -n 1)
    if [ -n "$found" ]; then
      echo "$found"
      return
    fi
  done
  echo "none"
}

test_suite() {
  local suite=$1 work=$systems/$suite clean=$systems/$suite-clean run tests tally package back_end
  bare "$suite" "$work" >"$systems/$suite-debootstrap.log" 2>&1
  mkdir "$work/root/tanktread"
  (cd "$root" && git ls-files -z --cached --others --exclude-standard | tar --null -T - -cf -) |
    tar -C "$work/root/tanktread" -xf -
  [ -z "$cache" ] || inside "$work" 'apt-get update -q && apt-get install -y -q --no-install-recommends ccache' \
                            >"$systems/$suite-ccache.log" 2>&1
  run=$(timed "$systems/$suite-run.log" "$work" \
              'cd /root/tanktread && ./tanktread.sh run scenes/tank-treading.toml -o out && test -s out/movie.mp4 &&
               ./tanktread.sh info out/frames/000000.png')
  tests=$(timed "$systems/$suite-test.log" "$work" 'cd /root/tanktread && ./tanktread.sh test')
  tally=$(sed -n 's/^.* \([0-9]*\) tests failed out of \([0-9]*\)$/\1 of \2 failed/p' "$systems/$suite-test.log" | tail -n 1)
  # The package is made in the first system, of what is built there, and installed and used in a second.
  package=$(timed "$systems/$suite-package.log" "$work" \
                  'cd /root/tanktread && apt-get install -y -q --no-install-recommends dpkg-dev file &&
                   cmake --preset release -DBUILD_TESTING=OFF && cmake --build build/release &&
                   cd build/release && cpack -G DEB')
  if [ "${package#ok}" != "$package" ]; then
    bare "$suite" "$clean" >>"$systems/$suite-debootstrap.log" 2>&1
    cp "$work"/root/tanktread/build/release/*.deb "$clean/root/"
    package=$(timed "$systems/$suite-installed.log" "$clean" \
                    'apt-get update -q && apt-get install -y -q /root/*.deb && cd /root &&
                     tanktread run /usr/share/tanktread/scenes/tank-treading.toml -o out && test -s out/movie.mp4 &&
                     test -s /usr/share/man/man1/tanktread.1')
  fi
  back_end=$(sed -n 's/^ *back_end[ :=]*//p' "$systems/$suite-run.log" | head -n 1)
  echo "| $suite $(cat "$work/etc/debian_version") | $run | $tests${tally:+; $tally} | $package | GCC $(chroot "$work" g++ -dumpfullversion)," \
       "CMake $(version "$work" cmake), Eigen $(version "$work" libeigen3-dev), HDF5 $(version "$work" libhdf5-dev)," \
       "fmt $(version "$work" libfmt-dev), Cairo $(version "$work" libcairo2-dev)," \
       "Mesa $(version "$work" libgl1-mesa-dri libosmesa6), OSMesa $(version "$work" libosmesa6)," \
       "Catch2 $(version "$work" catch2), Clang $(version "$work" clang)${back_end:+, drawn by $back_end} |"
}

echo "| system | \`run\` | \`test\` | package in a bare system | versions |"
echo "|---|---|---|---|---|"
for suite in "$@"; do test_suite "$suite"; done

#!/usr/bin/env bash
# From a fresh clone to a movie or a tested program, in one command:
#   ./tanktread.sh run SCENE [options]   simulate a scene and draw its movie (any other command of the program works too)
#   ./tanktread.sh test                  build everything and run all tests
# Installs the Debian packages that are missing (as root or with sudo), configures, builds, and goes. What is done is
# skipped the next time.
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release

packages=(g++ cmake ninja-build pkg-config libeigen3-dev libfftw3-dev libhdf5-dev libfmt-dev zlib1g-dev
          libtomlplusplus-dev libcli11-dev
          libglm-dev libpng-dev libcairo2-dev libfreetype-dev libgl-dev libegl-dev fonts-dejavu-core libosmesa6 ffmpeg
          catch2 libbenchmark-dev python3 python3-h5py)

# For the tests alone: fuzzing, and reading exported meshes back. Without them these tests are skipped.
test_packages=(clang libclang-rt-14-dev python3-vtk9)

usage() {
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
}

# Names of those packages that are not installed, one a line.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null |
              sed -n 's/ installed$//p' || true)
  local package
  for package in "${packages[@]}"; do
    grep -qxF -- "$package" <<<"$installed" || echo "$package"
  done
}

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    echo "tanktread.sh: this is no Debian; packages are taken as installed" >&2
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages)
  [ ${#missing[@]} -gt 0 ] || return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if command -v sudo >/dev/null; then
      as_root=(sudo)
    else
      echo "tanktread.sh: these packages are missing; please install them as root:" >&2
      echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 1
    fi
  fi
  echo "tanktread.sh: installing ${missing[*]}" >&2
  if ! { "${as_root[@]}" apt-get update -q &&
         "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"; } >&2
  then
    echo "tanktread.sh: the packages could not be installed; please do it by hand:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
}

# build_target TARGET: configures once; ninja sees for itself what has changed.
build_target() {
  if [ ! -f "$build/build.ninja" ]; then
    (cd "$root" && cmake --preset release) >&2
  fi
  cmake --build "$build" --target "$1" >&2
}

case "${1:-}" in
  "" | -h | --help)
    usage
    ;;
  test)
    shift
    packages+=("${test_packages[@]}")
    install_packages
    build_target all
    ctest --test-dir "$build" --output-on-failure -j "$(nproc)" "$@"
    ;;
  *)
    install_packages
    build_target tanktread
    exec "$build/tanktread" "$@"
    ;;
esac

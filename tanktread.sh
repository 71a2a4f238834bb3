#!/usr/bin/env bash
# From a fresh clone to a movie or a tested program, in one command:
#   ./tanktread.sh run SCENE [options]   simulate a scene and draw its movie (any other command of the program works too)
#   ./tanktread.sh test                  build everything and run all tests
# Installs the Debian packages that are missing (as root or with sudo), configures, builds, and goes. What is done is
# skipped the next time.
set -euo pipefail

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
build=$root/build/release

# What the program needs. Where names are joined by '|', the first that the system offers is enough.
packages=(g++ cmake ninja-build 'pkgconf|pkg-config' libeigen3-dev libfftw3-dev libtbb-dev libhdf5-dev libfmt-dev zlib1g-dev
          libtomlplusplus-dev libcli11-dev
          libglm-dev libpng-dev libcairo2-dev libfreetype-dev libfontconfig-dev libgl-dev libegl-dev fonts-dejavu-core
          fonts-dejavu-extra
          'libosmesa6|libegl1' 'libosmesa6|libgl1-mesa-dri' ffmpeg)

# What the tests need besides.
test_packages=(catch2 python3)

# What some tests need: the other back end of OpenGL, trajectories and meshes read back, benchmarks, fuzzing, a processor
# without AVX2, layout and mistakes of the code, the text of PDF files, several processes for one simulation. Where one of
# these cannot be installed, its tests are skipped.
optional_packages=(libosmesa6 libegl1 libgl1-mesa-dri libbenchmark-dev python3-h5py python3-vtk9 clang libclang-rt-dev
                   qemu-user clang-format clang-tidy poppler-utils
                   libopenmpi-dev openmpi-bin)

usage() {
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
}

# fail SENTENCE: ends the script.
fail() {
  echo "tanktread.sh: $1" >&2
  exit 1
}

# Those of the words given (names joined by '|') of which no package is installed, one a line.
missing_packages() {
  local word name found
  for word in "$@"; do
    found=
    for name in ${word//|/ }; do
      if [ "$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null)" = installed ]; then found=1; fi
    done
    [ -n "$found" ] || echo "$word"
  done
}

# For each of the words given the first package that the system offers, one a line; "-WORD" where it offers none.
offered_packages() {
  local word name found
  for word in "$@"; do
    found=-$word
    for name in ${word//|/ }; do
      if grep -q '^  Candidate: [^(]' <<<"$(LC_ALL=C apt-cache policy "$name" 2>/dev/null)"; then
        found=$name
        break
      fi
    done
    echo "$found"
  done
}

# install_packages REQUIRED... -- OPTIONAL...: without those required the script ends; the others are asked for once.
install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "tanktread.sh: this is no Debian; packages are taken as installed" >&2
    return
  fi
  local required=() optional=() as_root=() words=() word
  while [ "$1" != -- ]; do
    words+=("$1")
    shift
  done
  shift
  mapfile -t required < <(missing_packages "${words[@]}")
  [ $# -eq 0 ] || mapfile -t optional < <(missing_packages "$@")
  # What is only wished for, and not offered by the lists that are here, is no reason to fetch new ones each time.
  if [ ${#required[@]} -eq 0 ]; then
    [ ${#optional[@]} -gt 0 ] || return 0
    grep -qv '^-' <<<"$(offered_packages "${optional[@]}")" || return 0
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      [ ${#optional[@]} -eq 0 ] || skipped "${optional[@]}"
      [ ${#required[@]} -gt 0 ] || return 0
      by_hand $(offered_packages "${required[@]}" | sed 's/^-\(.*|\)\{0,1\}//')
    fi
    as_root=(sudo)
  fi
  local update=("${as_root[@]}" apt-get update -q)
  local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends)
  if ! "${update[@]}" >&2; then
    [ ${#required[@]} -eq 0 ] || fail "the lists of packages could not be fetched (apt-get update)"
    skipped "${optional[@]}"
    return 0
  fi
  if [ ${#required[@]} -gt 0 ]; then
    mapfile -t words < <(offered_packages "${required[@]}")
    for word in "${words[@]}"; do
      [ "${word#-}" = "$word" ] || fail "this system does not offer the package ${word#-}, which is needed"
    done
    echo "tanktread.sh: installing ${words[*]}" >&2
    "${install[@]}" "${words[@]}" >&2 || by_hand "${words[@]}"
  fi
  [ ${#optional[@]} -gt 0 ] || return 0
  required=("${optional[@]}")
  optional=()
  for word in $(offered_packages "${required[@]}"); do
    if [ "${word#-}" = "$word" ]; then
      optional+=("$word")
    else
      skipped "${word#-}"
    fi
  done
  [ ${#optional[@]} -gt 0 ] || return 0
  echo "tanktread.sh: installing ${optional[*]}" >&2
  "${install[@]}" "${optional[@]}" >&2 || skipped "${optional[@]}"
}

# skipped PACKAGE...: says what there will be no tests of.
skipped() { echo "tanktread.sh: tests that need these packages are skipped: $*" >&2; }

# by_hand PACKAGE...: ends the script.
by_hand() {
  echo "tanktread.sh: these packages are missing and could not be installed; please do it by hand, as root:" >&2
  echo "  apt-get install --no-install-recommends $*" >&2
  exit 1
}

# configure [OPTIONS]: CMake's options, and those of the environment variable TANKTREAD_CMAKE_OPTIONS.
configure() {
  local given
  read -ra given <<<"${TANKTREAD_CMAKE_OPTIONS:-}"
  (cd "$root" && cmake --preset release "$@" ${given[@]+"${given[@]}"}) >&2
}

case "${1:-}" in
  "" | -h | --help)
    usage
    ;;
  test)
    shift
    install_packages "${packages[@]}" "${test_packages[@]}" -- "${optional_packages[@]}"
    # Several processes for one simulation are tested where there is MPI.
    mpi=OFF
    if command -v mpicxx >/dev/null && command -v mpirun >/dev/null; then mpi=ON; fi
    configure -DBUILD_TESTING=ON -DTANKTREAD_MPI=$mpi
    cmake --build "$build" >&2
    ctest --test-dir "$build" --output-on-failure -j "$(nproc)" "$@"
    ;;
  *)
    install_packages "${packages[@]}" --
    # Configured once; ninja sees for itself what has changed.
    [ -f "$build/build.ninja" ] || configure -DBUILD_TESTING=OFF
    cmake --build "$build" --target tanktread >&2
    exec "$build/tanktread" "$@"
    ;;
esac

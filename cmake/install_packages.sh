#!/usr/bin/env bash
# Installs named sets of Debian 12 packages, leaving out what is there already: cmake/install_packages.sh SET...
#   build     what the libraries, the command and the tests need
#   demo      a test mesh and stock Draco's command line, to compare with
#   picture   an off-screen viewer for the demo's picture
#   plot      gnuplot, for the figures in docs/results
#   fuzz      clang with libFuzzer
#   validate  Node.js for the glTF validator
#   models    files made to test importers of glTF, for tests/bench/asset_table --models
#   batch     GNU parallel and Snakemake, to try the recipes of samples/batch
#   web       emscripten and Node.js for plugin/web, Chromium for its browser tests
#   lint      clang-format, clang-tidy and cppcheck
# Does nothing, without asking for root, when nothing is missing. Ends with 0 when all packages are there. These lists are
# the only ones in the repository.
set -euo pipefail

packages_of() {
  case $1 in
    build) echo cmake ninja-build g++ libdraco-dev draco libtinygltf-dev libeigen3-dev libtbb-dev \
      nlohmann-json3-dev libmeshoptimizer-dev libcli11-dev libgtest-dev libgmock-dev libbenchmark-dev python3 python3-jsonschema ;;
    demo) echo libcgal-demo draco python3 ;;
    picture) echo f3d xvfb xauth imagemagick fonts-dejavu-core ;;
    plot) echo gnuplot-nox fonts-dejavu-core ;;
    fuzz) echo clang-14 libclang-rt-14-dev ;;
    validate) command -v npm >/dev/null || echo nodejs npm ;;
    models) echo assimp-testmodels ;;
    batch) echo parallel snakemake ;;
    web) echo emscripten chromium; command -v npm >/dev/null || echo nodejs npm ;;
    lint) echo clang-format-14 clang-tidy-14 cppcheck ;;
    *) echo "unknown package set '$1'; $0 knows build, demo, picture, plot, fuzz, validate, models, batch, web, lint" >&2; return 2 ;;
  esac
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

[ $# -gt 0 ] || { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0"; exit 2; }
missing=()
for set in "$@"; do
  list=$(packages_of "$set")
  for package in $list; do is_installed "$package" || missing+=("$package"); done
done
[ ${#missing[@]} -gt 0 ] || exit 0

if ! command -v apt-get >/dev/null; then
  echo "missing: ${missing[*]}. There is no apt-get here: install what stands for them on your system." >&2
  exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "missing: ${missing[*]}. Run as root: apt-get install ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "-- installing ${missing[*]}"
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 "$@" >/dev/null; }
# A machine that knows these packages already needs no fresh lists; one whose lists are empty or old does.
apt install -y --no-install-recommends "${missing[@]}" 2>/dev/null ||
  { apt update && apt install -y --no-install-recommends "${missing[@]}"; }

#!/usr/bin/env bash
# Installs the Debian packages that are missing; does nothing, and asks for no rights, when all are there.
#   scripts/install_packages.sh            what building needs
#   scripts/install_packages.sh --tests    and what the tests need
#   scripts/install_packages.sh --python   and what the Python package needs
#   scripts/install_packages.sh --blender  and Blender, for the add-on's tests
#   scripts/install_packages.sh --wheels   and what wheels of it need (scripts/build_portable_wheels.py)
#   scripts/install_packages.sh --wine     and what tries the wheel for Windows (scripts/check_wheel_wine.py)
#   scripts/install_packages.sh --web      and what the page and its tests need (scripts/build_web.sh)
#   scripts/install_packages.sh --qgis     and QGIS, for its plugin and the tests of it (integrations/qgis)
#   scripts/install_packages.sh --release  and what a release needs besides (scripts/build_source.sh, check_dist.py)
#   scripts/install_packages.sh --tools    and what developers need: benchmarks, sanitizers, fuzzing, formatting, lint
# VANTAGE_NO_INSTALL=1 skips the check, for those who bring their own.
set -euo pipefail

packages=(
  # building
  g++ make cmake ninja-build ccache pkg-config
  # scripts/fetch_sources.sh
  python3 python3-pip ca-certificates
  # libraries
  libeigen3-dev libtbb-dev libyaml-cpp-dev libcli11-dev nlohmann-json3-dev libfmt-dev zlib1g-dev libembree-dev
  # rendering: headers only, the libraries themselves are loaded when there are any; and Mesa, which needs no GPU
  libegl-dev libgl-dev libegl1 libgl1-mesa-dri
  # pictures
  libcairo2-dev libfreetype-dev fonts-dejavu-core
  # maps and terrain; GDAL is loaded when there is one
  libosmium2-dev libproj-dev proj-data libpolyclipping-dev libgdal32
  # compressed meshes in glTF and 3D Tiles; vantage can be built without
  libdraco-dev libmeshoptimizer-dev
  # the server of `vantage view`: headers only
  libboost-dev
)
tests=(libgtest-dev osmium-tool locales)  # of locales one with a decimal comma is made
python=(python3-dev python3-venv)
blender=("${python[@]}" blender python3-numpy xvfb xauth)
wheels=("${python[@]}" patch xz-utils bzip2 tcl proj-data qemu-user-static)
wine=(wine64 wine maven)
web=(emscripten node-acorn chromium python3-venv)  # the last for scripts/check_wasm_wheel.sh
command -v npm >/dev/null || web+=(nodejs npm)  # there may be a newer one, of another source
qgis=(qgis python3-qgis qgis-providers python3-numpy xvfb)
release=(python3-venv dpkg-dev xz-utils git)
tools=(libbenchmark-dev clang libclang-rt-14-dev clang-format clang-tidy)

[ -z "${VANTAGE_NO_INSTALL:-}" ] || exit 0
case "${1:-}" in
  "") ;;
  --tests) packages+=("${tests[@]}") ;;
  --python) packages+=("${python[@]}") ;;
  --blender) packages+=("${blender[@]}") ;;
  --wheels) packages+=("${wheels[@]}") ;;
  --wine) packages+=("${wheels[@]}" "${wine[@]}") ;;
  --web) packages+=("${web[@]}") ;;
  --qgis) packages+=("${python[@]}" "${qgis[@]}") ;;
  --release) packages+=("${release[@]}") ;;
  --tools) packages+=("${tests[@]}" "${tools[@]}") ;;
  *)
    echo "usage: $0 [--tests|--python|--wheels|--wine|--blender|--web|--qgis|--release|--tools]" >&2
    exit 2
    ;;
esac
if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "not a Debian system: please install the equivalents of: ${packages[*]}" >&2
  echo "then set VANTAGE_NO_INSTALL=1" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) || status=none
  [[ $status == installed* ]] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "missing packages, and neither root nor sudo to install them. As root, run:" >&2
    echo "  apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
  [ -t 0 ] || as_root=(sudo --non-interactive)  # nobody is there to type a password
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@" >"$log" 2>&1 </dev/null &&
    return
  echo "apt-get $1 failed; its last lines:" >&2
  tail -n 15 "$log" >&2
  exit 1
}
echo "installing ${missing[*]}"
apt update
apt install --yes --no-install-recommends "${missing[@]}"

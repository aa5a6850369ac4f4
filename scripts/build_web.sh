#!/usr/bin/env bash
# Builds the page, web/dist/index.html: the engine as WebAssembly in build-web, then script, style and engine in one file.
#   scripts/build_web.sh            all of it
#   scripts/build_web.sh --engine   the engine alone: build-web/vantage.js and vantage.wasm
#   scripts/build_web.sh --package  that of the packages alone (make npm, make wheelwasm): build-web/package.js and .wasm
set -euo pipefail
cd "$(dirname "$0")/.."
build=$PWD/build-web
jobs=${JOBS:-$(nproc)}
# Acorn of Debian's package, whatever node there is.
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}
# Emscripten writes into its cache, which may belong to root.
export EM_CACHE=$build/cache
if ! command -v emcmake >/dev/null; then
  echo "Emscripten is not installed: run scripts/install_packages.sh --web" >&2
  exit 1
fi

scripts/fetch_sources.sh
scripts/fetch_web_sources.py
mkdir -p "$build"
[ -d "$EM_CACHE" ] || cp -r /usr/share/emscripten/cache "$EM_CACHE"
emcmake cmake -S web/engine -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release --log-level=WARNING >/dev/null
if [ "${1:-}" = --package ]; then
  cmake --build "$build" --parallel "$jobs" --target package_engine
  exit 0
fi
cmake --build "$build" --parallel "$jobs" --target engine
printf 'engine: %d bytes, %d gzipped\n' "$(stat -c %s "$build/vantage.wasm")" "$(gzip -9 -c "$build/vantage.wasm" | wc -c)"
[ "${1:-}" != --engine ] || exit 0

cd web
# Nothing of what the packages bring is run on installation; what esbuild runs is in the package of this platform.
npm ci --ignore-scripts --no-audit --no-fund
VANTAGE_ENGINE=$build npm run build

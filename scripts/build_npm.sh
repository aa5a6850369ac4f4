#!/usr/bin/env bash
# Builds the npm package into dist/ and tests it: web/npm. Needs build-web/package.js and .wasm (build_web.sh --package).
#   VANTAGE: the program whose volumes must have the same bytes (build/bin/vantage); CHROMIUM: /usr/bin/chromium
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
for file in build-web/package.js build-web/package.wasm; do
  [ -e "$file" ] || { echo "$file is missing: run scripts/build_web.sh --package" >&2; exit 1; }
done
cd web
[ -x node_modules/.bin/tsc ] && [ -x node_modules/.bin/playwright ] || npm ci --ignore-scripts --no-audit --no-fund
cd npm
rm -rf dist
../node_modules/.bin/tsc -p tsconfig.json
cp "$root/build-web/package.wasm" dist/vantage.wasm
# An ES module alone: what Emscripten adds for other kinds goes.
{ sed '/^if (typeof exports === /,$d' "$root/build-web/package.js"; echo 'export default createVantage;'; } >dist/vantage.js
cp src/vantage.d.ts dist/
# What is compiled in, as the licences ask.
cp "$root/LICENSE" .
{
  cat "$root/THIRD-PARTY-NOTICES.txt"
  for file in manifold/LICENSE cdt/LICENSE cdt/LICENSE-predicates.txt cdt/LICENSE-LLVM.txt web/yaml-cpp/LICENSE web/zlib/LICENSE; do
    printf '\n%s\n%s\n\n' "$(printf -- '-%.0s' {1..120})" "$file"
    cat "$root/.deps/$file"
  done
} >THIRD-PARTY-NOTICES.txt
number=$(sed -n 's/.*VANTAGE_VERSION "\([^"]*\)".*/\1/p' "$root/include/vantage/version.h")
grep -q "\"version\": \"$number\"" package.json || { echo "web/npm/package.json has another version than $number" >&2; exit 1; }
mkdir -p "$root/dist"
rm -f "$root"/dist/vantage-engine-*.tgz
npm pack --silent --pack-destination "$root/dist" >/dev/null
node --test tests/volumes.test.mjs
../node_modules/.bin/playwright test -c playwright.config.ts
du -b "$root"/dist/vantage-engine-*.tgz

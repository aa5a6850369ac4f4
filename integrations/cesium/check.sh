#!/usr/bin/env bash
# Computes the volume of examples/town as PLY and as 3D Tiles, checks the tileset by the rules of its formats and its
# positions by PROJ, and shows it in CesiumJS in headless Chromium, where facets are picked. See README.md beside it.
#   integrations/cesium/check.sh [FOLDER]    what it makes stays there; default: build/cesium
# VANTAGE names the program, PYTHON a Python with numpy and pyproj, CHROMIUM the browser.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../..
vantage=${VANTAGE:-$root/build/bin/vantage}
python=${PYTHON:-$root/.deps/python/bin/python}
folder=${1:-$root/build/cesium}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
"$here/install.sh"
"$vantage" compute "$root/examples/town/mission.yaml" -o "$folder/town.ply" -o "$folder/town.tiles" --quiet
"$python" "$here/check_tileset.py" "$folder/town.tiles" "$folder/town.ply"
"$python" "$here/picks.py" "$folder/town.ply" "$folder/picks.json"
node "$here/check.mjs" "$folder/town.tiles" "$folder/picks.json" "$folder/town.png"

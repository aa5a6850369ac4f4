#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Packs the add-on, installs the zip in a Blender with a configuration of its own, and runs the tests there; then, without
# TEST, those that need a window, under Xvfb.
#   integrations/blender/tests/run.sh [TEST ...]
# BLENDER names another Blender. Needs `make python` before: build/python and build/bin/vantage, or VANTAGE_BUILD.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
build=${VANTAGE_BUILD:-$root/build}
blender=${BLENDER:-blender}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 "$here/../build_zip.py"
mkdir -p "$folder"/{config,scripts/addons,extensions}
PYTHONPATH=$build/python BLENDER_USER_CONFIG=$folder/config BLENDER_USER_SCRIPTS=$folder/scripts \
  BLENDER_USER_EXTENSIONS=$folder/extensions \
  "$blender" --background --factory-startup --python-exit-code 1 --python "$here/run.py" -- \
  --zip "$root/dist/vantage_blender.zip" --vantage "$build/bin/vantage" "$@"
[ $# -eq 0 ] || exit 0
PYTHONPATH=$build/python BLENDER_USER_CONFIG=$folder/config LIBGL_ALWAYS_SOFTWARE=1 \
  xvfb-run --auto-servernum --server-args="-screen 0 1200x900x24 +extension GLX" \
  "$blender" --factory-startup --enable-event-simulate --window-geometry 0 0 1200 900 --python "$here/window.py"

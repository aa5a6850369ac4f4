#!/usr/bin/env bash
# Blender's exact boolean against ours: the spheres of three real targets (T1 to T3 of Charlotte, 100 and 300 m, 40 x 40
# texels a face) are made once, and both intersect the same meshes, one run after the other. Prints a table.
#   bench/blender/compare_booleans.sh [--seconds 300] [--memory 8] [--face-size 40 200] [--range 100 300]
#                                     [--sphere centers conservative] [--vantage PROGRAM]
# --seconds and --memory (GiB) limit each run of either program. Needs Blender (Debian: apt-get install blender) and
# ../shared or VANTAGE_SHARED. Opt-in: nothing else runs it, and it takes minutes.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
blender=${BLENDER:-blender}
if ! command -v "$blender" >/dev/null; then
  echo "skipped: there is no '$blender'; install it (Debian: apt-get install blender) or name it with BLENDER=" >&2
  exit 0
fi
program=$root/build/bin/vantage
if [ ! -x "$program" ] && [[ " $* " != *" --vantage "* ]]; then
  echo "there is no $program: run 'make build' first, or name one with --vantage" >&2
  exit 1
fi
exec python3 "$root/bench/blender/compare_booleans.py" --blender "$blender" "$@"

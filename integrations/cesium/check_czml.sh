#!/usr/bin/env bash
# Plans a flight in the invented town, writes it as CZML, loads that with Cesium in Node, and compares positions and
# times with what `vantage check` says of the same flight. Needs Node 20 or newer (Debian 12 has 18).
#   integrations/cesium/check_czml.sh [FOLDER]    what it makes stays there; default: build/cesium-czml
# VANTAGE names the program.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
program=$(realpath "${VANTAGE:-$root/build/bin/vantage}")
work=${1:-$root/build/cesium-czml}
sea_level=-540.5 undulation=45.75  # of the scene's z; metres

node=$(node --version)
if [[ ! $node =~ ^v([0-9]+)\. ]] || [ "${BASH_REMATCH[1]}" -lt 20 ]; then
  echo "node is $node, in which Cesium reads no CZML: install Node 20 or newer" >&2
  exit 1
fi
mkdir -p "$work"
cd "$work"
"$here/install.sh"
sed "s|osm: town.osm.*|osm: $root/examples/town/town.osm\n  sea_level: $sea_level|" \
  "$root/examples/town/tour.yaml" > tour.yaml
# The search for the tour has a time limit, so that two runs may differ: what is checked is made of the points that the
# same run prints.
"$program" tour tour.yaml -q --no-bound -o tour.czml --undulation $undulation --json > tour.json
python3 - <<'END'
import json
with open("tour.json") as told, open("tour.csv", "w") as table:
    table.write("x,y,z,hold\n")
    for point in json.load(told)["points"]:
        p = point["position"]
        table.write(f"{p[0]!r},{p[1]!r},{p[2]!r},{point['hold_s']!r}\n")
END
"$program" check tour.yaml tour.csv --heights scene --json > check.json || [ $? -eq 1 ]  # a limit may be broken
ellipsoid_z=$(python3 -c "print($sea_level - $undulation)")
node "$here/czml.mjs" "$here/node_modules/cesium" tour.czml check.json "$ellipsoid_z"

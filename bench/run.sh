#!/usr/bin/env bash
# Runs the engine's benchmarks and writes what they measured, with the ratios, to bench/results/<date>-<cpu>.md.
#   bench/run.sh [--no-file] [PROGRAM]     (build/bin/vantage_bench)
# --no-file only prints. FILTER=regex limits what is run. Needs ../shared or VANTAGE_SHARED.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
write=yes
[ "${1:-}" != --no-file ] || { write=no; shift; }
program=${1:-$root/build/bin/vantage_bench}
filter=${FILTER:-'^(engine|plain|depth|spheres)/'}

commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo unknown)
git -C "$root" diff --quiet HEAD -- src include cmake bench 2>/dev/null || commit+=" and changes"
cpu=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)
cpu=${cpu:-$(uname -m)}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# One process for the memory, another for the times: a peak is of a process.
run() {
  "$program" --benchmark_filter="$2" --benchmark_out="$out/$1.json" --benchmark_out_format=json \
    --benchmark_counters_tabular=false "${@:3}" >&2
}
load_before=$(cut -d ' ' -f 1 /proc/loadavg)
[ -n "${FILTER:-}" ] || run prepare '^prepare/'
run engine "$filter" --benchmark_enable_random_interleaving=true
load_after=$(cut -d ' ' -f 1 /proc/loadavg)

python3 "$root/bench/report.py" --commit "$commit" --cpu "$cpu" --threads "$(nproc)" --load "$load_before, $load_after" \
  "$out"/*.json >"$out/report.md"
cat "$out/report.md"
if grep -q '^- skipped: ' "$out/report.md" && [ "$write" = yes ]; then
  echo "not written: not everything was measured" >&2
elif [ "$write" = yes ]; then
  name=$(tr '[:upper:]' '[:lower:]' <<<"$cpu" | tr -cs 'a-z0-9' - | sed 's/^-//; s/-$//')
  file=bench/results/$(date +%F)-$name.md
  mkdir -p "$root/bench/results"
  cp "$out/report.md" "$root/$file"
  echo "written: $file" >&2
fi

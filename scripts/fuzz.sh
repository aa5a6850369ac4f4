#!/usr/bin/env bash
# Runs every fuzz target for some seconds (default 60) each; exit 1 if any crashes, hangs, leaks or takes too much memory.
#   scripts/fuzz.sh [SECONDS]       BUILD: the folder of the build (build-fuzz)
# Seeds: tests/fuzz/seeds/<subject>/, words: tests/fuzz/<subject>.dict, both optional. What is found on the way is kept in
# $BUILD/corpus/, what fails in $BUILD/findings/.
set -euo pipefail
cd "$(dirname "$0")/.."
duration=${1:-60}
build=${BUILD:-build-fuzz}
shopt -s nullglob
targets=(tests/fuzz/fuzz_*.cpp)
if [ ${#targets[@]} -eq 0 ]; then
  echo "fuzz: no targets in tests/fuzz/" >&2
  exit 1
fi
# A leak or a sanitizer report ends the run of its target.
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
failed=()
total=0
for target in "${targets[@]}"; do
  name=$(basename "$target" .cpp)
  subject=${name#fuzz_}
  corpus=$build/corpus/$subject findings=$build/findings/$subject
  mkdir -p "$corpus" "$findings"
  options=(-max_total_time="$duration" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1
    -artifact_prefix="$findings/")
  seeds=(tests/fuzz/seeds/"$subject"/)
  [ -d "${seeds[0]}" ] || seeds=()
  [ ! -e "tests/fuzz/$subject.dict" ] || options+=(-dict="tests/fuzz/$subject.dict")
  log=$build/$subject.log
  if "$build/bin/fuzz/$name" "${options[@]}" "$corpus" "${seeds[@]}" >"$log" 2>&1 </dev/null; then
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    total=$((total + runs))
    echo "$name: $runs inputs, nothing found"
  else
    failed+=("$name")
    tail -n 40 "$log"
    echo "$name: FAILED, the input is in $findings/, the log in $log" >&2
  fi
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "fuzz: FAILED: ${failed[*]}"
  exit 1
fi
echo "fuzz: ${#targets[@]} targets, $total inputs, nothing found"

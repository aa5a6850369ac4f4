#!/usr/bin/env bash
# Builds the libraries in ways that neither `make build` nor the tests use, installs each, and runs a program that finds
# it there: all of them static, some parts alone, no threads. For `make nightly`.
#   scripts/build_variants.sh [NAME...]     all of them, or those that are named; VARIANTS: the folder (build-variants)
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath -m "${VARIANTS:-build-variants}")
jobs=${JOBS:-$(nproc)}

# NAME  consumer: everything or embedder  options
variants=(
  "static      everything -DBUILD_SHARED_LIBS=OFF"
  "static-core embedder   -DBUILD_SHARED_LIBS=OFF -DVANTAGE_COMPONENTS=core -DVANTAGE_THREADS=none"
  "missions    embedder   -DVANTAGE_COMPONENTS=missions -DVANTAGE_THREADS=std"
  "no-maps     embedder   -DVANTAGE_COMPONENTS=picture"
)

plaza=$PWD/examples/plaza

# build_variant NAME CONSUMER OPTION...
build_variant() {
  local name=$1 consumer=$2 own=$folder/$1
  shift 2
  echo "=== $name: $*"
  cmake -S . -B "$own" -G Ninja -DCMAKE_BUILD_TYPE=Release -DVANTAGE_BUILD_TESTS=OFF -DVANTAGE_BUILD_BENCHMARKS=OFF \
    --log-level=WARNING "$@" >/dev/null
  cmake --build "$own" --parallel "$jobs" | tail -n 1
  rm -rf "$own/prefix" "$own/consumer"
  cmake --install "$own" --prefix "$own/prefix" >/dev/null
  cmake -S "tests/consumer/$consumer" -B "$own/consumer" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$own/prefix" -DEXAMPLES="$PWD/examples/headers" --log-level=WARNING >/dev/null
  cmake --build "$own/consumer" --parallel "$jobs" | tail -n 1
  case $consumer in
    everything) "$own/consumer/consumer" "$plaza/mission.yaml" "$own/volume.ply" ;;
    embedder) "$own/consumer/embedder" "$plaza/plaza.obj" "$own/volume.ply" ;;
  esac
}

count=0
for variant in "${variants[@]}"; do
  read -r name consumer options <<<"$variant"
  if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
  # shellcheck disable=SC2086  # options are words
  build_variant "$name" "$consumer" $options
  count=$((count + 1))
done
echo "variants: $count built, installed and used"
[ "$count" -gt 0 ]

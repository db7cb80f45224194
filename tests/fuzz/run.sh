#!/usr/bin/env bash
# Builds the fuzz targets, tries inputs on each and prints a table.
#   tests/fuzz/run.sh [RUNS] [TARGET...]     1000000 inputs for each target when left out
# Needs clang, libclang-rt-14-dev and llvm-14 (Debian) beside what setup.sh installs. SECONDS_EACH=600 in the environment
# ends every target after so many seconds; BUILD names another build folder; SANITIZERS= (empty) leaves address and
# undefined-behaviour sanitizers out, which is several times as fast. Exit code 1 when anything was found.
set -euo pipefail
cd "$(dirname "$0")/../.."

runs=${1:-1000000}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(scene override study csv conic layout packet rayfile lm63 eulumdat netpbm png iges step)
build=${BUILD:-build-fuzz}
most_seconds=${SECONDS_EACH:-0}

cmake --preset fuzz -B "$build" -DCATOPTRIC_FUZZ_SANITIZERS="${SANITIZERS-,address,undefined}" >/dev/null
export ASAN_OPTIONS=malloc_context_size=4 # where memory came from is told by a second run
programs=(fuzz_dictionary)
for target in "${targets[@]}"; do
  case $target in
    iges | step) programs+=(fuzz_exchange) ;;
    *) programs+=("fuzz_$target") ;;
  esac
done
cmake --build "$build" --target "${programs[@]}" >&2
bin=$build/tests/fuzz
work=$build/fuzz
mkdir -p "$work"
"$bin/fuzz_dictionary" >"$work/dictionary"

# A TM-25 file without its descriptions and a Zemax file, of two rays each; the first byte says which (targets/rayfile.h).
ray_files() {
  local rays='\0\0\200\77\0\0\0\0\0\0\0\100\0\0\0\0\0\0\0\0\0\0\200\77\0\0\200\77' one='\1\0\0\0'
  {
    printf '\1TM25\335\7\0\0\0\0\0\0\0\0\240\177\0\0\0\100\2\0\0\0\0\0\0\0'
    head -c 228 /dev/zero
    printf "$one$one$one"
    head -c 20 /dev/zero
    printf "$rays$rays"
  } >"$1/tm25"
  {
    printf '\0\362\3\0\0\2\0\0\0'
    head -c 200 /dev/zero
    printf "$rays$rays"
  } >"$1/zemax"
}

# Valid inputs to begin with, and all that ever broke the target.
seeds() {
  local folder=$work/corpus/$1
  mkdir -p "$folder" "$work/found/$1"
  [ ! -d "data/fuzz/$1" ] || cp data/fuzz/"$1"/* "$folder"
  case $1 in
    scene) cp data/paper/start_*.toml data/paper/paraboloid.toml data/examples/*.toml "$folder" ;;
    study) cp data/paper/table2*.toml "$folder" ;;
    override) printf 'model.photons=1000\x1esource.position=[0,0,5]\x1etitle=a b' >"$folder/seed" ;;
    csv)
      for kind in 0 1 2 3 4; do
        printf '%sx,y,z,irradiance,move\n0,0,0,1,2\n' "$kind" >"$folder/points_$kind"
        printf '%sradius,irradiance,weight\n0,1,1\n1,0.5,2\n' "$kind" >"$folder/radial_$kind"
        printf '%sangle,intensity\n0,1\n10,0.5\n' "$kind" >"$folder/angles_$kind"
      done
      ;;
    lm63)
      local counts='1 -1 1 3 2 1 2 0.1 0.2 0 1 1 10' head
      for head in '' 'IESNA91' 'IESNA:LM-63-1995' 'IESNA:LM-63-2002' 'IES:LM-63-2019'; do
        printf '%s\n[TEST] 1\n[MORE] 2\nTILT=NONE\n%s\n0 45 90\n0 90\n3 2 1\n3 1 0\n' "$head" "$counts" >"$folder/c_${head:0-4}"
        printf '%s\nTILT=INCLUDE\n1 2 0 90 1 1\n%s\n0 45 90\n0 90\n3 2 1\n3 1 0\n' "$head" "${counts/2 1 2/2 2 1}" >"$folder/b_${head:0-4}"
      done
      ;;
    eulumdat)
      for symmetry in 0 1 2 3 4; do
        { printf 'c\n3\n%s\n4\n90\n3\n45\nr\nn\nn\nf\nd\n' $symmetry
          printf '1\n%.0s' 1 2 3 4 5 6 7 8 9 10 11 12 && printf '0\n1\n2\nLED\n2000\n4000\n80\n25\n'
          printf '0.5\n%.0s' 1 2 3 4 5 6 7 8 9 10 && printf '0\n90\n180\n270\n0\n45\n90\n'
          printf '5\n2,5\n1\n%.0s' $(seq $((symmetry == 0 ? 4 : symmetry == 1 ? 1 : symmetry == 4 ? 2 : 3)))
        } >"$folder/isym_$symmetry"
      done
      ;;
    netpbm)
      printf 'P2\n# c\n3 2\n9\n0 1 2\n3 4 9\n' >"$folder/p2"
      printf 'P5\n2 2\n255\nabcd' >"$folder/p5"
      printf 'P5 2 1 1000\n\1\2\3\4' >"$folder/p5_two_bytes"
      printf 'Pf\n2 1\n-1.0\n\0\0\200\77\0\0\0\100' >"$folder/pfm_little"
      printf 'Pf\n1 2\n1.0\n\77\200\0\0\100\0\0\0' >"$folder/pfm_big"
      ;;
    png) # as targets/png.h takes them: chunks, and pixels of several depths, interlaced or not
      local name=0 head
      for head in '\2\2\10\0\0' '\2\2\20\0\0' '\3\1\4\0\0' '\11\1\1\0\1' '\1\1\10\4\0' '\1\1\10\2\0'; do
        printf "\2$head"'\0abcdefghijkl' >"$folder/pixels_$((name += 1))"
        printf "\1${head}gAMA\4\0\0\261\217sRGB\1\0tRNS\2\0\1" >"$folder/chunks_$name"
      done
      printf '\1\1\1\10\0\0IDAT\15\170\1\1\2\0\375\377\0a\0c\0b' >"$folder/whole"
      ;;
    layout) cp data/profiles/*.igs "$folder" ;;
    rayfile) ray_files "$folder" ;;
  esac
}

libfuzzer() {
  local target=$1 log=$work/$1.log
  seeds "$target"
  "$bin/fuzz_$target" "$work/corpus/$target" -runs="$runs" -seed=1 -max_total_time="$most_seconds" -max_len=8192 \
    -timeout=20 -rss_limit_mb=2048 -dict="$work/dictionary" -artifact_prefix="$work/found/$target/" -print_final_stats=1 \
    >"$log" 2>&1 || true
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
}

exchange() {
  local log=$work/$1.log
  mkdir -p "$work/tmp"
  local limit=()
  [ "$most_seconds" -eq 0 ] || limit=(-seconds="$most_seconds")
  TMPDIR=$work/tmp "$bin/fuzz_exchange" "$1" -runs="$runs" -seed=1 -limit=100 "${limit[@]}" -keep="$work/found/$1" >"$log" 2>&1 || true
  inputs=$(sed -n 's/^\(iges\|step\) \([0-9]*\) inputs.*/\2/p' "$log" | tail -1)
}

failed=0
echo "| target | inputs | seconds | inputs/s | found |"
echo "|---|---|---|---|---|"
for target in "${targets[@]}"; do
  begin=$(date +%s)
  inputs=0
  case $target in
    iges | step) exchange "$target" ;;
    *) libfuzzer "$target" ;;
  esac
  seconds=$(($(date +%s) - begin))
  found=$(grep -c -E 'FINDING|^SUMMARY: |libFuzzer: (deadly|timeout|out-of-memory)' "$work/$target.log" || true)
  [ "$found" -eq 0 ] || failed=1
  echo "| $target | ${inputs:-0} | $seconds | $((${inputs:-0} / (seconds > 0 ? seconds : 1))) | $found |"
done
exit $failed

#!/usr/bin/env bash
# The whole suite under asan and ubsan, and sim and optim under tsan; the last line counts the programs and twins.
#   tests/sanitizers/run.sh [asan] [tsan]     both when left out
# On two cores it takes some half an hour, most of it compiling, which is why setup.sh --test does not call it.
set -euo pipefail
cd "$(dirname "$0")/../.."
presets=("$@")
[ ${#presets[@]} -gt 0 ] || presets=(asan tsan)

passed=0
failed=0

# Adds a build folder's tests to the counts. A run that ends without a count is a failure of its own.
run_tests_of() {
  local log=$1/test.log total bad
  ctest --test-dir "$1" --output-on-failure -j "$(nproc)" 2>&1 | tee "$log" || true
  total=$(sed -n 's/.*tests failed out of \([0-9]*\).*/\1/p' "$log" | tail -1)
  bad=$(sed -n 's/.*, \([0-9]*\) tests failed out of .*/\1/p' "$log" | tail -1)
  if [ -z "$total" ] || [ "$total" -eq 0 ]; then
    echo "no test was run in $1" >&2
    total=1 bad=1
  fi
  passed=$((passed + total - bad))
  failed=$((failed + bad))
}

export CCACHE_SLOPPINESS=pch_defines,time_macros # or ccache stores nothing that has a precompiled header
for preset in "${presets[@]}"; do
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset"
  run_tests_of "build-$preset"
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

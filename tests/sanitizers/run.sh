#!/usr/bin/env bash
# The sanitized tests that setup.sh --test leaves out: cases that take long (tag [long]; 1,000-seed runs with tag [.] not
# even here), the rooms report and cli, and all of sim under the thread sanitizer. Run setup.sh --test first; this adds
# some minutes of compiling. The last line counts the programs.
set -euo pipefail
cd "$(dirname "$0")/../../build"

cmake . -DCATOPTRIC_SANITIZED_ROOMS="base;cluster;cad;sim;optim;photometry;rayfiles;images;design;report;cli" >/dev/null
cmake --build .
cd tests

passed=0
failed=0
for program in test_{cad,sim,design,report}_asan test_sim_tsan test_cli; do
  cases="[long]~[unsanitized]~[.]"
  case $program in
    # Ray tubes are traced by one thread.
    test_sim_tsan) cases="~[tubes]~[unsanitized]~[.]" ;;
    test_report_asan | test_cli) cases="~[unsanitized]~[.]" ;;
  esac
  [ "$program" != test_cli ] || export CATOPTRIC_PROGRAM=$PWD/../src/cli/catoptric_asan
  echo "== $program"
  if "./$program" "$cases" --warn NoTests; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
  fi
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

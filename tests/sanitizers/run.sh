#!/usr/bin/env bash
# The sanitized tests that setup.sh --test leaves out because they take long (tag [long]), and 1,000-seed runs with tag
# [.] not even then. Run setup.sh --test first. The last line counts the programs.
set -euo pipefail
cd "$(dirname "$0")/../../build/tests"

passed=0
failed=0
for program in test_{cad,sim,design}_asan test_sim_tsan "test_cli"; do
  [ "$program" != test_cli ] || export CATOPTRIC_PROGRAM=$PWD/../src/cli/catoptric_asan
  echo "== $program"
  if "./$program" "[long]~[unsanitized]~[.]" --warn NoTests; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
  fi
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]

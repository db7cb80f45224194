#!/bin/sh
# The table of the extremes: what was tried, by which judge, how far off. Usage: tests/extremes/table.sh [build folder]
build=${1:-build}/tests
echo '| engine | rays, weights that act together | tried | wrong | off, of the part, times the cosine of incidence | normal, rad |'
echo '|---|---|---|---|---|---|'
"$build/test_cad" '[extremes]' | grep '^| '
"$build/test_design" '[extremes]' | grep -E '^[|] (scenes|accuracy of|mirrors)'
"$build/test_design" '[scale]~[.long]' | grep ', allowed '

#!/usr/bin/env bash
# Makes the paper's figures 1 to 4 as tables (CSV) and plots (SVG) under a folder, out/figures by default.
#   data/paper/figures.sh [FOLDER]
# About two minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
out=${1:-out/figures}
run() { build/catoptric "$@" --quiet; }

# Figure 1: the paraboloid's generatrix and the irradiance it makes
run simulate data/paper/paraboloid.toml --out "$out/figure1"

# Figure 2: starts A, B, C, what they light, and what the searches of Table 2 made of them
run study data/paper/table2.toml --out "$out/figure2"

# Photons, as in the paper.
landscape() { run landscape "$@" --set model.rung=photons --set model.photons=20000; }

# Figure 3: the objective around the global minimum, as surfaces, and its contours with the searches from A, B and C
landscape data/paper/start_a.toml --out "$out/figure3" --set landscape.paths=true \
  --set 'landscape.starts=[[1.8, 7], [0.7071067811865476, 5]]'

# Figure 4: contours with the search paths of runs 1 to 5 (start A), 6 and 7 (B), 8 (C)
paths() { for k in "$@"; do printf -- '--path %s ' "$out/figure2/$k/convergence.csv"; done; }
# shellcheck disable=SC2046  # the words are meant to be split
landscape data/paper/start_a.toml --out "$out/figure4a" $(paths 1 2 4 5)
# shellcheck disable=SC2046
landscape data/paper/start_b.toml --out "$out/figure4b" $(paths 6 7) \
  --set 'landscape.upper=[21, 13]'
# shellcheck disable=SC2046
landscape data/paper/start_c.toml --out "$out/figure4c" $(paths 8)
echo "figures are under $out: figure1/figures/*.svg, figure2/*/figures/*.svg, figure3/figures, figure4*/figures"

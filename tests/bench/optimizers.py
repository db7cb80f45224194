#!/usr/bin/env python3
"""Compares the searches on the paper's three starts: evaluations and time to a given RMSE, as a markdown table.

  tests/bench/optimizers.py build/catoptric                 all methods, five seeds, some minutes
  tests/bench/optimizers.py build/catoptric --seeds 2 --methods "cma-es; genetic"
Ray tubes are the evaluator, with the kernel of the scenes (0.5 cm). A mirror in a far corner of the box is a deep
cavity: light is followed through four meetings there, which the searches' goal, light reflected once, does not feel.
Methods without random numbers run once for each start, others once for each seed.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTARTED = {"search.restarts": 100000}
METHODS = {
    "hooke-jeeves": {},
    "hooke-jeeves, restarts": {"search.method": "hooke-jeeves", **RESTARTED},
    "levenberg-marquardt": {},
    "levenberg-marquardt, restarts": {"search.method": "levenberg-marquardt", **RESTARTED},
    "nelder-mead": {},
    "nelder-mead, restarts": {"search.method": "nelder-mead", **RESTARTED},
    "compass": {},
    "compass, restarts": {"search.method": "compass", **RESTARTED},
    "cma-es": {},
    "cma-es, restarts": {"search.method": "cma-es", **RESTARTED},
    "differential-evolution": {},
    "self-adaptive-de": {},
    "particle-swarm": {},
    "simulated-annealing": {},
    "genetic": {},
}
WITHOUT_RANDOM_NUMBERS = {"hooke-jeeves", "levenberg-marquardt", "nelder-mead", "compass"}


def search(program, start, method, seed, options):
    """The result of one design run; its verdict is kept cheap, since the search alone is measured."""
    keys = {"search.method": method, "seed": seed, "search.reach": options.reach,
            "search.most_evaluations": options.evaluations, "model.interactions": 4, "model.rung": "tubes",
            "model.photons": 1000, "model.replicates": 2, "threads": 1, **METHODS[method]}
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "design", str(ROOT / f"data/paper/start_{start}.toml"), "--quiet",
                   "--out", folder + "/run"]
        for key, value in keys.items():
            command += ["--set", f"{key}={value}"]
        ended = subprocess.run(command, text=True, capture_output=True)
        if ended.returncode not in (0, 5):  # 5: the goal was not reached
            raise SystemExit(f"{ended.stdout}{ended.stderr}{' '.join(command)}: exit code {ended.returncode}")
        return json.loads(pathlib.Path(folder, "run/result.json").read_text())


def cell(results, reach):
    """Successes, then the medians of the successful runs."""
    good = [result for result in results if result["search_value"] <= reach]
    if not good:
        return f"0/{len(results)} (best {min(result['search_value'] for result in results):.2g})"
    evaluations = statistics.median(result["counts"]["evaluations"] for result in good)
    seconds = statistics.median(result["seconds_search"] for result in good)
    return f"{len(good)}/{len(results)}: {evaluations:.0f}, {1e3 * seconds:.0f} ms"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="catoptric, built for release")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--reach", type=float, default=0.005, help="RMSE to reach, W/m^2")
    parser.add_argument("--evaluations", type=int, default=3000, help="budget of one run")
    parser.add_argument("--methods", help="names, separated by semicolons")
    options = parser.parse_args()
    names = [name.strip() for name in options.methods.split(";")] if options.methods else list(METHODS)

    print(f"Successes: evaluations, time to RMSE {options.reach:g} W/m^2; at most {options.evaluations} evaluations")
    print("\n| Method | A | B | C |\n|---|---|---|---|", flush=True)
    for method in names:
        seeds = 1 if method in WITHOUT_RANDOM_NUMBERS else options.seeds
        row = [cell([search(options.program, start, method, seed, options) for seed in range(1, seeds + 1)],
                    options.reach) for start in "abc"]
        print(f"| {method} | " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""How a run's time falls with ranks (strong) and stays as the work grows with them (weak): elapsed times of one session,
in turns, one thread a rank. Writes what src/cluster/SIZING.md states.

Usage: scaling.py PROGRAM SCENES (data) [--ranks 1,2,4] [--rounds 5] [--only NAME]; nothing else may run on the machine."""
import argparse
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

parser = argparse.ArgumentParser()
parser.add_argument("program", type=pathlib.Path)
parser.add_argument("scenes", type=pathlib.Path)
parser.add_argument("--ranks", default="1,2,4")
parser.add_argument("--rounds", type=int, default=5)
parser.add_argument("--only", default="")
options = parser.parse_args()
PROGRAM, SCENES = options.program.resolve(), options.scenes.resolve()
RANKS = [int(each) for each in options.ranks.split(",")]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def seconds(ranks, arguments):
    """Of a whole command as the user waits for it, launcher included; 0 ranks: without mpirun."""
    launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks else []
    with tempfile.TemporaryDirectory() as out:
        command = launcher + [str(PROGRAM)] + [str(each) for each in arguments] + ["--quiet", "--threads", "1", "--out", out]
        begin = time.monotonic()
        ended = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True)
        took = time.monotonic() - begin
    if ended.returncode not in (0, 5):  # 5: a search used up its evaluations
        raise SystemExit(f"{' '.join(command)} ended with {ended.returncode}: {ended.stderr}")
    return took


def sets(**values):
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


PARABOLOID, START, GLASS = SCENES / "paper/paraboloid.toml", SCENES / "paper/start_a.toml", SCENES / "examples/cover_glass.toml"
PHOTONS = dict(model__rung="photons")


def photons(size):
    return ["simulate", PARABOLOID] + sets(model__photons=2**24, model__replicates=8 * size, **PHOTONS)


def batches(size):
    return ["simulate", PARABOLOID] + sets(model__photons=size * 2**26, model__replicates=2, **PHOTONS)


def accuracy(_):
    return ["simulate", GLASS] + sets(accuracy=0.03, model__most_photons=60_000_000, **PHOTONS)


def search(method, photons_of_each):
    return lambda _: ["design", START] + sets(
        model__photons=photons_of_each, model__replicates=2, search__method=method, search__most_evaluations=EVALUATIONS,
        search__population=16, search__smallest_step=1e-6, **PHOTONS)


def study(size):
    folder = pathlib.Path(tempfile.mkdtemp())
    runs = "".join(f'[[runs]]\nname = "r{i}"\nset = {{"seed" = {i}}}\n' for i in range(16 * size))
    (folder / "study.toml").write_text(f'title = "Seeds"\ncommand = "simulate"\nscene = "{PARABOLOID}"\n{runs}')
    return ["study", folder / "study.toml"] + sets(model__photons=2_000_000, model__replicates=4, **PHOTONS)


def sensitivity(_):
    return ["sensitivity", START] + sets(model__photons=20_000, **PHOTONS)


# What, whether the work grows with the ranks too, how many pieces there are of what unit.
EVALUATIONS = 64
WORK = {"8 replicates of 2^24 photons": (photons, True, 8 * 2**24, "photon"),
        "4 batches of each of 2 replicates": (batches, True, 2 * 2**26, "photon"),
        "accuracy 0.03 by photons through glass": (accuracy, False, 37_816_320, "photon"),
        "CMA-ES, 64 evaluations of 300,000 photons": (search("cma-es", 300_000), False, EVALUATIONS, "evaluation"),
        "Hooke-Jeeves, 64 evaluations of 10^6 photons": (search("hooke-jeeves", 1_000_000), False, EVALUATIONS, "evaluation"),
        "study of 16 simulations": (study, True, 16, "run"),
        "sensitivity, 10 deviations": (sensitivity, False, 14_400_000, "photon")}

# Of what every command takes before and after its work.
SMALL = ["simulate", PARABOLOID] + sets(model__photons=1024, model__replicates=2, **PHOTONS)
idle = {ranks: [] for ranks in [0] + RANKS}
for _ in range(options.rounds):
    for ranks in idle:
        idle[ranks].append(seconds(ranks, SMALL))
print("start, report and end:", ", ".join(f"{ranks} ranks {statistics.median(times):.2f} s" if ranks else
                                  f"without mpirun {statistics.median(times):.2f} s" for ranks, times in idle.items()))

for name, (work, grows, pieces, piece) in WORK.items():
    if options.only not in name:
        continue
    strong, weak = {ranks: [] for ranks in RANKS}, {2: []} if grows else {}
    for turn in range(options.rounds):
        for ranks in RANKS if turn % 2 == 0 else RANKS[::-1]:
            strong[ranks].append(seconds(ranks, work(1)))
        for ranks in weak:
            weak[ranks].append(seconds(ranks, work(ranks)))
    one = strong[RANKS[0]]

    def ratio(times):
        each = sorted(base / time for base, time in zip(one, times))
        return f"{statistics.median(each):.2f} ({each[0]:.2f} to {each[-1]:.2f})"

    of_a_piece = (statistics.median(one) - statistics.median(idle[RANKS[0]])) / pieces
    print(f"{name}: {statistics.median(one):.2f} s on {RANKS[0]} rank, {of_a_piece:.3g} s a {piece};",
          "; ".join(f"{ranks} ranks {ratio(strong[ranks])} times as fast" for ranks in RANKS[1:]),
          "".join(f"; weak, {ranks} times the work on {ranks} ranks: efficiency {ratio(times)}" for ranks, times in weak.items()), flush=True)

#!/usr/bin/env python3
"""Tailors the paper's mirror in all its five variables from random starts, and has photons judge what comes.

  tests/bench/any_start.py build/catoptric            100 starts, under a minute

Every start has random poles and a random weight; `search.free = "profile"` moves all that changes the shape. The
judge is the photon rung with another seed each time, 8 x 100,000 Sobol photons under a kernel of 0.5 cm: its
own noise is in the figure.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile

SCENE = """unit = "cm"
start = "tailored"
[source]
position = [0, 0, 5]
power = 0.031415926535897934
[reflector]
degree = 2
points = [[0, {z0}], [{r1}, {z0}], [{r2}, {z2}]]
weights = [1, {w1}, 1]
[near_field]
radius = 5
[target]
kind = "paraboloid"
focal_length = 5
[model]
rung = "photons"
kernel_radius = 0.5
[search]
free = "profile"
metric = "relative-rmse"
"""


def random_scene(numbers):
    return SCENE.format(
        z0=numbers.uniform(6, 20),
        r1=numbers.uniform(1, 15),
        w1=math.exp(numbers.uniform(math.log(0.05), math.log(20))),
        r2=numbers.uniform(2, 30),
        z2=numbers.uniform(0, 9),
    )


def judged(program, scene, seed, folder):
    path = folder / "scene.toml"
    path.write_text(scene)
    command = [program, "simulate", path, "--seed", str(seed), "--out", folder / "out", "--quiet"]
    subprocess.run(command, check=True)
    return json.loads((folder / "out" / "result.json").read_text())["objective"]["value"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="catoptric, built for release")
    parser.add_argument("--starts", type=int, default=100)
    options = parser.parse_args()
    numbers = random.Random(3)
    with tempfile.TemporaryDirectory() as folder:
        values = [
            judged(options.program, random_scene(numbers), seed + 1, pathlib.Path(folder))
            for seed in range(options.starts)
        ]
    within = sum(value <= 0.005 for value in values)
    print(f"{within} of {len(values)} starts within a relative RMSE of 0.5 %, the greatest {max(values):.4f}")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Compares the benchmarks of two commits in one session, by ratio.

  tests/bench/compare.py main HEAD                         all benchmarks
  tests/bench/compare.py main HEAD --filter meridian --rounds 9
Both commits are built in worktrees of their own; then the benchmarks run in turn, A B B A A B B A, so that a
machine that slows down slows both. Shown is the median over the rounds of time(change) / time(base), with the
least and greatest: below 1 the change is faster. A benchmark that only one commit has is listed without a
ratio.
"""

import argparse
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile

import benchmarks


def checked_out(commit, folder):
    tree = pathlib.Path(folder) / commit
    benchmarks.run(["git", "-C", str(benchmarks.ROOT), "worktree", "add", "--detach", "--quiet", str(tree), commit])
    return tree


def time_of(name, value):
    """Of several threads only the clock on the wall tells; of one the processor's, which others disturb less."""
    return value["ns" if name.endswith("/real_time") else "cpu_ns"]


def rounds(base, change, options):
    """Times of both by "program/benchmark", one for each round."""
    times = ({}, {})
    for name in sorted(base.keys() | change.keys()):
        for number in range(options.rounds):
            order = (0, 1) if number % 2 == 0 else (1, 0)
            for side in order:
                program = (base, change)[side].get(name)
                if program is None:
                    continue
                for key, value in benchmarks.measure(program, options.filter, options.min_time).items():
                    times[side].setdefault(f"{name.removeprefix('bench_')}: {key}", {})[number] = time_of(key, value)
        print(f"{name}: {options.rounds} rounds", flush=True)
    return times


def human(nanoseconds):
    for unit, size in (("s", 1e9), ("ms", 1e6), ("us", 1e3)):
        if nanoseconds >= size:
            return f"{nanoseconds / size:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


def print_table(times):
    before, after = times
    names = sorted(before.keys() | after.keys())
    width = max(map(len, names), default=9)
    print(f"\n{'benchmark':{width}}  {'base':>9}  {'change':>9}  {'ratio':>6}  least  greatest")
    ratios = []
    for name in names:
        old, new = before.get(name, {}), after.get(name, {})
        cells = [human(statistics.median(side.values())) if side else "-" for side in (old, new)]
        each = [new[number] / old[number] for number in old.keys() & new.keys()]
        if each:
            ratios.append(statistics.median(each))
            tail = f"{ratios[-1]:6.3f}  {min(each):5.3f}  {max(each):8.3f}"
        else:
            tail = "only in " + ("base" if old else "change")
        print(f"{name:{width}}  {cells[0]:>9}  {cells[1]:>9}  {tail}")
    if ratios:
        print(f"{'geometric mean of the ratios':{width}}  {'':9}  {'':9}  {statistics.geometric_mean(ratios):6.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("base")
    parser.add_argument("change")
    parser.add_argument("--filter", default="", help="regular expression on the benchmark's name")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--min-time", type=float, default=0.2, help="seconds for each benchmark and round")
    options = parser.parse_args()

    commits = [benchmarks.commit_of(benchmarks.ROOT, name) for name in (options.base, options.change)]
    if commits[0] == commits[1]:
        raise SystemExit("compare: both names mean the same commit")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("compare: stopped"))  # the worktrees go all the same
    with tempfile.TemporaryDirectory(prefix="catoptric-compare-") as folder:
        trees = []
        try:
            for commit in commits:
                trees.append(checked_out(commit, folder))
            programs = [benchmarks.build(tree) for tree in trees]
            print(f"base {commits[0]}, change {commits[1]}, {benchmarks.machine()['model']}", flush=True)
            print_table(rounds(*programs, options))
        finally:
            for tree in trees:
                subprocess.run(["git", "-C", str(benchmarks.ROOT), "worktree", "remove", "--force", str(tree)])


if __name__ == "__main__":
    main()

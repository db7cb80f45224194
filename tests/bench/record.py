#!/usr/bin/env python3
"""Builds and runs all benchmarks and stores what they say under tests/bench/records/.

  tests/bench/record.py                          everything, some minutes
  tests/bench/record.py --filter mesh            benchmarks whose name matches
  tests/bench/record.py --repetitions 5          the median of five runs of each
The file is named after date, commit and processor. Run it on a quiet machine.
"""

import argparse
import datetime
import json
import re

import benchmarks


def median_of(runs):
    """The run with the median time, so that its counters belong to it; and the spread of all."""
    ordered = sorted(runs, key=lambda each: each["ns"])
    middle = dict(ordered[(len(ordered) - 1) // 2])
    if len(ordered) > 1:
        middle["spread"] = round(ordered[-1]["ns"] / ordered[0]["ns"], 3)
    return middle


def rounded(value, digits=5):
    if isinstance(value, dict):
        return {key: rounded(each, digits) for key, each in value.items()}
    return float(f"{value:.{digits}g}") if isinstance(value, float) else value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--filter", default="", help="regular expression on the benchmark's name")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--min-time", type=float, default=0.5, help="seconds for each benchmark and repetition")
    options = parser.parse_args()

    programs = benchmarks.build(benchmarks.ROOT)
    results = {}
    for name, program in programs.items():
        print(name, flush=True)
        runs = [benchmarks.measure(program, options.filter, options.min_time) for _ in range(options.repetitions)]
        common = {key: median_of([run[key] for run in runs if key in run]) for key in runs[0]}
        if common:
            results[name] = rounded(common)
    if not results:
        raise SystemExit("record: no benchmark matches the filter")

    commit = benchmarks.commit_of(benchmarks.ROOT)
    # The record itself is no change; anything else is.
    changed = benchmarks.run(["git", "-C", str(benchmarks.ROOT), "status", "--porcelain", "--", ".",
                              ":!tests/bench/records"]).strip()
    machine = benchmarks.machine()
    today = datetime.date.today().isoformat()
    record = {"date": today, "commit": commit + ("-dirty" if changed else ""), "machine": machine,
              "filter": options.filter, "repetitions": options.repetitions, "unit": "ns", "benchmarks": results}
    slug = re.sub(r"[^a-z0-9]+", "-", machine["model"].lower()).strip("-")
    path = benchmarks.ROOT / "tests/bench/records" / f"{today}_{record['commit']}_{slug}.json"
    path.parent.mkdir(exist_ok=True)
    # One benchmark a line: small, and a change shows as one line.
    lines = [json.dumps({key: value for key, value in record.items() if key != "benchmarks"})[:-1]
             + ', "benchmarks": {']
    groups = []
    for name, entries in results.items():
        rows = ",\n".join(f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in entries.items())
        groups.append(f' {json.dumps(name)}: {{\n{rows}\n }}')
    lines.append(",\n".join(groups))
    lines.append("}}")
    path.write_text("\n".join(lines) + "\n")
    print(f"wrote {path.relative_to(benchmarks.ROOT)}")


if __name__ == "__main__":
    main()

"""What record.py and compare.py share: building the benchmarks, running them, naming the machine."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NANOSECONDS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
# What Google Benchmark says of each run besides its counters.
NO_COUNTERS = {
    "name", "run_name", "run_type", "family_index", "per_family_instance_index", "repetitions",
    "repetition_index", "threads", "iterations", "real_time", "cpu_time", "time_unit",
    "error_occurred", "error_message", "aggregate_name", "aggregate_unit", "label",
}


def run(command, **options):
    """What a command prints; ends the script with it when the command fails."""
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, **options)
    if done.returncode != 0:
        raise SystemExit(f"{done.stdout}{' '.join(map(str, command))}: exit code {done.returncode}")
    return done.stdout


def commit_of(tree, revision="HEAD"):
    return run(["git", "-C", str(tree), "rev-parse", "--short=10", revision + "^{commit}"]).strip()


def build(tree):
    """Configures and builds everything that preset `bench` has; returns the programs by name."""
    # Paths relative to the tree, so that ccache serves one worktree from another.
    quiet = {"cwd": tree, "env": {**os.environ, "CCACHE_BASEDIR": str(tree), "CCACHE_NOHASHDIR": "1"}}
    run(["cmake", "--preset", "bench"], **quiet)
    configured = (pathlib.Path(tree) / "tests" / "bench").glob("*_bench.cpp")
    names = sorted("bench_" + path.name.removesuffix("_bench.cpp") for path in configured)
    run(["cmake", "--build", "build-bench", "--target", *names], **quiet)
    folder = pathlib.Path(tree) / "build-bench" / "tests"
    return {name: folder / name for name in names}


def measure(program, filter_="", min_time=0.5):
    """One run of a program: {benchmark: {"ns", "cpu_ns", "counters"}}, those that failed left out."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        command = [str(program), "--benchmark_out=" + out.name, "--benchmark_out_format=json",
                   f"--benchmark_min_time={min_time}"]
        if filter_:
            command.append("--benchmark_filter=" + filter_)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        text = pathlib.Path(out.name).read_text()
    if not text.strip():  # the filter leaves nothing of this program
        return {}
    results = {}
    for entry in json.loads(text)["benchmarks"]:
        if entry.get("error_occurred"):
            print(f"{entry['name']}: {entry.get('error_message', 'failed')}", file=sys.stderr)
            continue
        to_ns = NANOSECONDS[entry["time_unit"]]
        results[entry["name"]] = {
            "ns": entry["real_time"] * to_ns,
            "cpu_ns": entry["cpu_time"] * to_ns,
            "counters": {key: value for key, value in entry.items()
                         if key not in NO_COUNTERS and isinstance(value, (int, float))},
        }
    return results


def machine():
    """Model of the processor, cores, compiler."""
    fields = dict(re.findall(r"^([^:\n]+):\s*(.+)$", run(["lscpu"], env={**os.environ, "LC_ALL": "C"}), re.M))
    compiler = run([os.environ.get("CXX", "c++"), "--version"]).splitlines()[0]
    return {"model": fields.get("Model name", "unknown"), "cores": os.cpu_count(),
            "architecture": fields.get("Architecture", "unknown"), "compiler": compiler}

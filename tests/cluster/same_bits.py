#!/usr/bin/env python3
"""Runs one command by one process and by 1, 2 and 3 ranks and compares the bytes of all files but for times; kills
a rank, fails a rank, breaks a search off and resumes it on another number of ranks.

Usage: same_bits.py PROGRAM SCENES (data/paper); ends with 77 where mpirun is not there or cannot start anything, or the program has no MPI."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM, SCENES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
LONGEST = 120  # s, on a machine that is shared
SMALL = "--set model.photons=4000 --set model.replicates=3 --set near_field.samples=60".split()
SEARCH = SMALL + "--set model.rung=photons --set search.smallest_step=0.2".split()
checks = 0


def check(sound, what):
    global checks
    checks += 1
    if not sound:
        sys.exit(f"FAILED: {what}")


def words(ranks, arguments):
    launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks else []
    return launcher + [str(PROGRAM)] + [str(each) for each in arguments]


# mpirun refuses root unless it is told that this is meant.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


def run(ranks, arguments):
    return subprocess.run(words(ranks, arguments), env=ENVIRONMENT, timeout=LONGEST, capture_output=True, text=True)


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(each) for key, each in value.items() if not key.startswith("seconds")}
    return [without_times(each) for each in value] if isinstance(value, list) else value


def content(file):
    """What must repeat. The page shows times, and STEP and IGES the minute of their writing."""
    if file.suffix == ".json":
        return json.dumps(without_times(json.loads(file.read_text())))
    text = file.read_bytes()
    if file.suffix == ".toml":
        return re.sub(rb"threads = \d+", b"", text)
    if file.suffix == ".html":  # times in words, and those of a study's runs in the last column of its table
        return re.sub(rb"threads = \d+|[0-9.e-]+ (s|ms|min)\b|[0-9.e-]+</td></tr>", b"", text)
    if file.name == "study.csv":
        rows = [line.split(",") for line in file.read_text().splitlines()]
        return [[cell for name, cell in zip(rows[0], row) if "seconds" not in name and "time" not in name] for row in rows]
    if file.suffix == ".step":
        return re.sub(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", b"", text)
    if file.suffix == ".igs":
        return re.sub(rb"\d{8}\.\d{6}", b"", text)
    return text


def contents(folder):
    return {str(file.relative_to(folder)): content(file) for file in sorted(folder.rglob("*")) if file.is_file()}


def same(name, work, arguments, code, ranks=(1, 2, 3)):
    alone = work / name / "alone"
    ended = run(0, arguments + ["--threads", 1, "--out", alone])
    check(ended.returncode == code, f"{name} alone ended with {ended.returncode}: {ended.stderr}")
    expected = contents(alone)
    check(expected, f"{name} wrote nothing")
    for count in ranks:
        out = work / name / str(count)
        threads = 1 + count % 2  # other than alone for most
        shared = run(count, arguments + ["--threads", threads, "--out", out])
        check(shared.returncode == code, f"{name} on {count} ranks ended with {shared.returncode}: {shared.stderr}")
        found = contents(out)
        check(found.keys() == expected.keys(), f"{name} on {count} ranks: {sorted(found)}, not {sorted(expected)}")
        for file, text in expected.items():
            check(found[file] == text, f"{name} on {count} ranks: {file} differs")
        if "--quiet" not in arguments:
            check(shared.stdout.count("written to") == 1, f"{name} on {count} ranks: not one rank speaks:\n{shared.stdout}")


def traded(work):
    """Times differ, and with them what is left out; the truth may not."""
    truths = []
    for ranks in (0, 2):
        out = work / "traded" / str(ranks)
        scene = ["tradeoff", SCENES.parent / "examples/cover_glass.toml", "--out", out, "--threads", 1, "--set", "near_field.samples=60"]
        ended = run(ranks, scene + "--set tradeoff.seconds=0.05 --set tradeoff.most_photons=3000 --set tradeoff.seeds=2".split())
        check(ended.returncode == 0, f"tradeoff on {ranks} ranks ended with {ended.returncode}: {ended.stderr}")
        check(ended.stdout.count("written to") == 1, f"tradeoff on {ranks} ranks: not one rank speaks:\n{ended.stdout}")
        truths.append(re.findall("truth: .*?\\)", ended.stdout))
    check(len(truths[0]) == 1 and truths[0] == truths[1], f"the truth of a tradeoff is another on 2 ranks: {truths}")


def study_file(folder):
    runs = "".join(f'[[runs]]\nname = "{name}"\nset = {{{change}}}\n' for name, change in [
        ("a", '"seed" = 2'), ("b", '"variables.w1.start" = 1.5'), ("d", '"model.rung" = "photons"'),
        ("refused", '"model.rung" = "photons", "search.method" = "levenberg-marquardt"')])
    file = folder / "study.toml"
    file.write_text(f'title = "Four"\ncommand = "design"\nscene = "{SCENES / "start_a.toml"}"\n{runs}')
    return file


def children(parent):
    for entry in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            name, rest = entry.read_text().rsplit(")", 1)
        except OSError:
            continue
        if int(rest.split()[1]) == parent and "catoptric" in name:
            yield int(entry.parent.name)


def long_run(ranks, out):
    """A search that takes minutes, some evaluations along."""
    arguments = ["design", SCENES / "start_a.toml", "--out", out, "--quiet", "--threads", 1] + \
        "--set model.rung=photons --set model.photons=300000 --set search.smallest_step=1e-9".split()
    process = subprocess.Popen(words(ranks, arguments), env=ENVIRONMENT, stderr=subprocess.PIPE, text=True)
    begin = time.monotonic()
    while not (out / "checkpoint.json").exists():
        check(process.poll() is None, "a long run ended before its first checkpoint")
        check(time.monotonic() - begin < LONGEST, "a long run wrote no checkpoint")
        time.sleep(0.02)
    return process


def gone(process):
    begin = time.monotonic()
    while pathlib.Path(f"/proc/{process}").exists():
        if time.monotonic() - begin > 20:
            return False
        time.sleep(0.02)
    return True


def killed_rank(work):
    process = long_run(2, work / "killed")
    victims = list(children(process.pid))
    check(len(victims) == 2, f"two ranks were expected, {victims} found")
    os.kill(victims[-1], signal.SIGKILL)
    _, errors = process.communicate(timeout=LONGEST)
    check(process.returncode != 0, "a killed rank ended the run with 0")
    check("signal 9" in errors or "Killed" in errors, f"a killed rank was not told of: {errors}")
    check(all(gone(each) for each in victims), "a rank is left")


def interrupted(work):
    process = long_run(2, work / "interrupted")
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=LONGEST)
    check(process.returncode != 0, f"an interrupted run ended with 0: {errors}")
    check((work / "interrupted/checkpoint.json").exists(), "an interrupted run left no checkpoint")


def told_to_stop(work):
    process = long_run(2, work / "stopped")
    process.send_signal(signal.SIGUSR1)
    _, errors = process.communicate(timeout=LONGEST)
    check(process.returncode == 130, f"a run told to stop ended with {process.returncode}: {errors}")
    outcome = json.loads((work / "stopped/result.json").read_text())["outcome"]
    check(outcome == "interrupted", f"a run told to stop is {outcome}")
    check((work / "stopped/checkpoint.json").exists(), "a run told to stop left no checkpoint")


def resumed(work):
    scene = ["design", SCENES / "start_a.toml"] + SEARCH
    whole, broken = work / "whole", work / "broken"
    check(run(0, scene + ["--out", whole]).returncode == 0, "the whole search failed")
    first = run(2, scene + ["--out", broken, "--set", "search.most_evaluations=9"])
    check(first.returncode == 5, f"a search out of budget ended with {first.returncode}: {first.stderr}")
    check((broken / "checkpoint.json").exists(), "a search out of budget left no checkpoint")
    rest = run(3, scene + ["--out", broken, "--resume"])
    check(rest.returncode == 0, f"a resumed search ended with {rest.returncode}: {rest.stderr}")
    check(contents(whole) == contents(broken), "a search resumed on 3 ranks is another than one in one go")


def failures(work):
    bad = run(3, ["simulate", SCENES / "start_a.toml", "--set", "model.photon=1"])
    check(bad.returncode == 3, f"a bad scene ended with {bad.returncode}")
    check(bad.stderr.count("did you mean") == 1, f"not one rank tells of a bad scene: {bad.stderr}")
    (work / "file").write_text("")
    full = run(3, ["simulate", SCENES / "start_a.toml", "--out", work / "file"] + SMALL)
    check(full.returncode == 6, f"a folder that cannot be made ended with {full.returncode}: {full.stderr}")


def other_version(work):
    """A file without the function that this program asks for, as another version of it would be."""
    libraries = subprocess.run(["ldd", str(PROGRAM)], capture_output=True, text=True).stdout
    folder = work / "other"
    folder.mkdir()
    shutil.copy(PROGRAM, folder / "catoptric")
    shutil.copy(re.search(r"libm\.so\.6 => (\S+)", libraries).group(1), folder / "catoptric_mpi.so")
    ended = subprocess.run(["mpirun", "--oversubscribe", "-n", "2", str(folder / "catoptric"), "--version"], env=ENVIRONMENT,
                           timeout=LONGEST, capture_output=True, text=True)
    check(ended.returncode == 2, f"a module of another version ended with {ended.returncode}: {ended.stderr}")
    check("another version" in ended.stderr, f"a module of another version was not told of: {ended.stderr}")


def main():
    if not shutil.which("mpirun") or not (PROGRAM.parent / "catoptric_mpi.so").exists():
        print("no mpirun, or built without MPI: nothing compared")
        sys.exit(77)
    # A machine may have Open MPI and forbid what it needs (sockets, shared memory): that is no fault of the program's.
    bare = subprocess.run(["mpirun", "--oversubscribe", "-n", "2", "true"], env=ENVIRONMENT, capture_output=True, text=True)
    if bare.returncode != 0:
        print(f"mpirun cannot start anything here: nothing compared\n{bare.stderr}")
        sys.exit(77)
    start_a, paraboloid = SCENES / "start_a.toml", SCENES / "paraboloid.toml"
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        same("simulate", work, ["simulate", paraboloid] + SMALL + ["--set", "model.rung=photons"], 0)
        same("by tubes", work, ["design", start_a] + SMALL, 0, (2,))
        same("pattern", work, ["design", start_a] + SEARCH, 0)
        same("population", work, ["design", start_a] + SEARCH +
             "--set search.method=cma-es --set search.most_evaluations=25".split(), 5, (3,))
        same("accuracy by photons", work, ["simulate", paraboloid] +
             "--set model.rung=photons --set accuracy=0.01".split(), 0)
        # Out of photons on purpose: sets of 2^21 photons are kept in two slices.
        same("accuracy in slices", work, ["simulate", paraboloid] +
             "--set model.rung=photons --set accuracy=1e-6 --set model.most_photons=12000000".split(), 5)
        same("accuracy by rings", work, ["simulate", paraboloid] +
             "--set model.rung=rings --set accuracy=0.001".split(), 0)
        same("accuracy of a design", work, ["design", start_a, "--set", "accuracy=0.02"], 0, (2,))
        same("sensitivity", work, ["sensitivity", start_a] + SMALL + ["--set", "model.rung=photons"], 0)
        same("landscape", work, ["landscape", start_a] + SMALL +
             "--set model.rung=photons --set landscape.steps=[4,3]".split(), 0)
        traded(work)
        same("study", work, ["study", study_file(work)] + SMALL, 4)
        same("study of fewer runs than ranks", work, ["study", study_file(work)] + SMALL, 4, (5,))
        resumed(work)
        failures(work)
        other_version(work)
        killed_rank(work)
        interrupted(work)
        told_to_stop(work)
    print(f"{checks} checks: the same files on 1, 2 and 3 ranks")


main()

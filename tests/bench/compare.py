#!/usr/bin/env python3
"""What a step costs in two builds, side by side: compare.py BEFORE AFTER [SCENE] [--set KEY=VALUE ...].

BEFORE and AFTER are two tanktread programs. Instructions a step are counted by valgrind, as the difference of two runs of which
one takes N steps more: starting and plans cancel out. Processor times are those of runs that alternate, since the speed of a
machine wanders; the ratio is given with its spread. One thread, fixed steps of 0.1 unless --set says otherwise.
"""

import argparse
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIRST = 3  # steps in which a multistep formula gathers its past


def command(program, scene, steps, settings, folder):
    fixed = ["time.step=0.1", "time.end=1e6", "time.save_every=1e6"]
    sets = [word for setting in fixed + settings for word in ("--set", setting)]
    return [program, "simulate", scene, "-q", "-j", "1", "--force", "--steps", str(steps), "-o", f"{folder}/run.h5"] + sets


def instructions(program, scene, steps, settings, folder):
    """A step, in millions."""
    counts = []
    for n in (FIRST, FIRST + steps):
        run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/calls"]
                             + command(program, scene, n, settings, folder), capture_output=True, text=True)
        found = re.search(r"Collected : (\d+)", run.stderr)
        if run.returncode != 0 or not found:
            sys.exit(f"{program} did not run under valgrind: {run.stderr[-500:]}")
        counts.append(int(found.group(1)))
    return (counts[1] - counts[0]) / steps / 1e6


def seconds(program, scene, steps, settings, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command(program, scene, steps, settings, folder), check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("scene", nargs="?", default=str(ROOT / "scenes/tumbling.toml"))
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the scene; any number of times")
    parser.add_argument("--counted", type=int, default=10, help="steps that are counted (default: 10)")
    parser.add_argument("--timed", type=int, default=100, help="steps that are timed (default: 100)")
    parser.add_argument("--runs", type=int, default=5, help="timed runs of each; 0: only count (default: 5)")
    options = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    programs = [str(Path(p).resolve()) for p in (options.before, options.after)]
    with tempfile.TemporaryDirectory() as folder:
        counts = [instructions(p, options.scene, options.counted, options.set, folder) for p in programs]
        print(f"instructions a step, in millions: {counts[0]:.2f} before, {counts[1]:.2f} after, "
              f"ratio {counts[1] / counts[0]:.3f}")
        if options.runs == 0:
            return
        times = [[seconds(p, options.scene, options.timed, options.set, folder) for p in programs] for _ in range(options.runs)]
        ratios = sorted(after / before for before, after in times)
        print(f"processor time of {options.timed} steps, in seconds: {statistics.median(t[0] for t in times):.2f} before, "
              f"{statistics.median(t[1] for t in times):.2f} after, ratio {statistics.median(ratios):.3f} "
              f"({ratios[0]:.3f} to {ratios[-1]:.3f})")


if __name__ == "__main__":
    main()

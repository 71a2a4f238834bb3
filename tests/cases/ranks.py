#!/usr/bin/env python3
"""One simulation by several processes under mpirun: the same bytes for any number of them, also after a kill."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = sys.argv[1]
SKIPPED = 77
FREE = """
[flow]
kind = "shear"
[time]
end = 0.3
save_every = 0.1
[[vesicle]]
shape = "prolate"
order = 5
reduced_volume = 0.9
viscosity_contrast = 2.0
[[placement]]
kind = "box"
count = 4
"""
PERIODIC = FREE + "[cell]\nsize = [7, 7, 7]\n"
TOUCHING = "[[vesicle]]\norder = 4\n[[vesicle]]\norder = 4\ncenter = [1.5, 0, 0]\n"

# More ranks than processors, and as root in a container: Open MPI wants to be told. Threads would only fight here.
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe",
                   OMPI_MCA_btl_base_warn_component_unused="0")
# Processes that wait let the others work.
ENVIRONMENT["OMPI_MCA_mpi_yield_when_idle"] = "1"
# On this machine only: no shell for others is looked for.
ENVIRONMENT["OMPI_MCA_plm"] = "isolated"


def command(ranks, *words):
    return (["mpirun", "-n", str(ranks)] if ranks > 1 else []) + [PROGRAM, "simulate", "-q", *words]


def run(ranks, *words):
    return subprocess.run(command(ranks, *words), env=ENVIRONMENT, capture_output=True, text=True, timeout=300)


def check(true, reason):
    if not true:
        sys.exit(f"ranks: {reason}")


def succeed(ranks, *words):
    done = run(ranks, *words)
    check(done.returncode == 0, f"{ranks} processes, {' '.join(words)}: status {done.returncode}: {done.stderr}")


def same(a, b, what):
    check(Path(a).read_bytes() == Path(b).read_bytes(), f"{what}: the trajectories differ")


def sentences(text):
    return [line for line in text.splitlines() if line.startswith("tanktread: ")]


def main():
    if not shutil.which("mpirun"):
        return SKIPPED
    if subprocess.run(["mpirun", "-n", "3", "true"], env=ENVIRONMENT, capture_output=True).returncode != 0:
        print("ranks: mpirun starts no three processes here")
        return SKIPPED
    Path("free.toml").write_text(FREE)
    Path("periodic.toml").write_text(PERIODIC)
    Path("touching.toml").write_text(TOUCHING)
    probe = run(2, "free.toml", "-o", "probe.h5", "--steps", "1")
    if "built without MPI" in probe.stderr:
        check(probe.returncode != 0 and not Path("probe.h5").exists(), "without MPI two processes wrote a file")
        return SKIPPED
    check(probe.returncode == 0, f"two processes: {probe.stderr}")

    for scene, ranks in (("free", 2), ("periodic", 3)):
        succeed(1, f"{scene}.toml", "-o", f"{scene}1.h5")
        succeed(ranks, f"{scene}.toml", "-o", f"{scene}{ranks}.h5")
        same(f"{scene}1.h5", f"{scene}{ranks}.h5", f"{scene}, one process and {ranks}")

    succeed(3, "free.toml", "-o", "parts.h5", "--steps", "2")
    succeed(1, "free.toml", "-o", "parts.h5", "--resume", "--steps", "4")
    succeed(2, "free.toml", "-o", "parts.h5", "--resume")
    same("free1.h5", "parts.h5", "resumed with other numbers of processes")

    # One of two processes is killed where it happens to be: the other ends, and what is in the file goes on.
    long = ["free.toml", "--set", "time.end=30", "--steps", "150"]
    started = subprocess.Popen(command(2, *long, "-o", "killed.h5"), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    ranks = []
    while not Path("killed.h5").exists() or len(ranks) < 2:
        check(started.poll() is None, "the run that was to be killed ended by itself")
        time.sleep(0.05)
        children = Path(f"/proc/{started.pid}/task/{started.pid}/children").read_text().split()
        ranks = [int(child) for child in children]
    time.sleep(0.2)
    os.kill(ranks[-1], signal.SIGKILL)
    check(started.wait(timeout=60) != 0, "a run without one of its processes ended well")
    succeed(1, *long, "-o", "killed.h5", "--resume")
    succeed(1, *long, "-o", "whole.h5")
    same("killed.h5", "whole.h5", "killed and resumed")

    for words in (["touching.toml", "-o", "no.h5"], ["free.toml", "-o", "free1.h5"], ["missing.toml"]):
        refused = run(2, *words)
        check(refused.returncode != 0, f"{words}: status 0")
        check(len(sentences(refused.stderr)) == 1, f"{words}: not one sentence: {refused.stderr}")
    check(not Path("no.h5").exists(), "a scene that cannot start has left a file")
    return 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        sys.exit(main())

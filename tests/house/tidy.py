#!/usr/bin/env python3
"""clang-tidy over sim, render and app by .clang-tidy: tidy.py BUILD [-j N] [FOLDER or FILE...].

Most of its time goes into the headers of Eigen, fmt and the standard library, which it reads and checks anew for each file. So
the files of a folder are checked as one; where names clash, in parts. Flags are those of BUILD.
Status 1 when it finds something, 77 when clang-tidy is missing or has another version: each finds other things.
"""

import argparse
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
VERSION = "14"
MODULES = ["sim", "render", "app"]


def program():
    for name in (f"clang-tidy-{VERSION}", "clang-tidy"):
        if shutil.which(name):
            said = subprocess.run([name, "--version"], capture_output=True, text=True).stdout
            if f"version {VERSION}." in said:
                return name
    print(f"clang-tidy {VERSION} is not here: the code is not checked by it")
    sys.exit(77)


def flags_of(command):
    """What clang needs of a command for g++: neither its files nor GCC's precompiled header."""
    words = iter(shlex.split(command)[1:])
    flags = []
    for word in words:
        if word in ("-o", "-c", "-include"):
            next(words)
        elif word != "-Winvalid-pch":
            flags.append(word)
    # A local name of one file may well be a name of the file after it; within one file GCC tells of shadows.
    return [*flags, "-Werror", "-Wno-shadow"]


def folders(build, wanted):
    """(flags, files) of each folder, the largest first, so that no processor waits long for the last."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = Path(entry["directory"], entry["file"])
        if not path.is_relative_to(ROOT) or path.relative_to(ROOT).parts[0] not in MODULES:
            continue
        if wanted and not any(path == name or name in path.parents for name in wanted):
            continue
        found.setdefault((path.parent, tuple(flags_of(entry["command"]))), []).append(path)
    groups = [(flags, files) for (_, flags), files in found.items()]
    return sorted(groups, key=lambda group: -sum(path.stat().st_size for path in group[1]))


def run(tidy, path, flags):
    command = [tidy, "--quiet", f"--config-file={ROOT / '.clang-tidy'}", str(path), "--", *flags]
    done = subprocess.run(command, capture_output=True, text=True)
    said = done.stdout
    if done.returncode != 0 and "error:" not in said:
        said += f"{path}: clang-tidy ends with status {done.returncode}\n{done.stderr}"
    return done.returncode, said


def check(tidy, flags, files, scratch):
    """What clang-tidy says of these files; empty where it finds nothing."""
    if len(files) == 1:
        status, said = run(tidy, files[0], flags)
        return said if status else ""
    # Text after text: some checks leave out what the file at hand includes.
    together = Path(tempfile.mkstemp(suffix=".cpp", dir=scratch)[1])
    texts = [path.read_text().splitlines() for path in files]
    together.write_text("".join(line + "\n" for text in texts for line in text))
    origins = [(path, number + 1) for path, text in zip(files, texts) for number in range(len(text))]
    status, said = run(tidy, together, flags)
    if status == 0:
        return ""
    said = re.sub(re.escape(f"{together}:") + r"(\d+)", lambda found: "{}:{}".format(*origins[int(found[1]) - 1]), said)
    if "[clang-diagnostic-error]" not in said:
        return said
    # A name that stands in two files: the second of them is where it is an error.
    lines = [line for line in said.splitlines() if "[clang-diagnostic-error]" in line]
    apart = [path for path in files if any(line.startswith(f"{path}:") for line in lines)]
    rest = [path for path in files if path not in apart]
    parts = [apart, rest] if apart and rest else [[path] for path in files]
    print(f"{files[0].parent.relative_to(ROOT)}: names clash, its files are checked in {len(parts)} parts", flush=True)
    return "".join(check(tidy, flags, part, scratch) for part in parts)


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("build", type=Path)
    options.add_argument("-j", type=int, default=len(os.sched_getaffinity(0)))
    options.add_argument("wanted", nargs="*", type=Path)
    given = options.parse_args()
    tidy = program()
    groups = folders(given.build, [path.resolve() for path in given.wanted])
    if not groups:
        sys.exit("tidy.py: no such files are compiled")
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(given.j) as workers:
        results = list(workers.map(lambda group: check(tidy, *group, scratch), groups))
    # A header is read by several folders.
    findings = dict.fromkeys(found for said in results for found in re.split(r"(?m)^(?=\S+:\d+:\d+: (?:error|warning):)", said))
    print("".join(findings), end="")
    return 1 if any(results) else 0


sys.exit(main())

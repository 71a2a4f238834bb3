#!/usr/bin/env python3
"""Makes the pictures of docs/gallery.md again: gallery.py PROGRAM [--update] [--work FOLDER] [-k WORD].

Runs the commands that stand on the page, simulations first, in FOLDER (default: a temporary one), and compares what
they draw with docs/pictures; with --update puts it there. Status 1 when a picture has changed. -k takes only the pictures
whose name contains WORD. Look at the pictures before a change of them goes in. Movies take a minute and depend on the
version of ffmpeg: they are made with --update only, and otherwise their size is checked.
"""

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def commands(page):
    """Simulations: lines of the shell block. Pictures: commands in backticks; both as lists of words."""
    block = re.search(r"^```sh\n(.*?)^```", page, re.S | re.M).group(1)
    simulations = [shlex.split(line) for line in block.splitlines() if line.strip()]
    pictures = [shlex.split(text) for text in re.findall(r"`(tanktread (?:render|figure) [^`]* -o gallery/[^`]*)`", page)]
    return simulations, pictures


def output_of(words):
    return words[words.index("-o") + 1]


def movie_format(words):
    """None for pictures."""
    return words[words.index("--format") + 1] if "--format" in words else None


MOST_BYTES = 2_000_000  # of a movie: a page that is slow to load is not read


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("--update", action="store_true")
    arguments.add_argument("--work")
    arguments.add_argument("-k", dest="word", default="")
    given = arguments.parse_args()
    program = str(Path(given.program).resolve())
    page = (ROOT / "docs" / "gallery.md").read_text()
    simulations, pictures = commands(page)
    shown = set(re.findall(r"\]\(pictures/([\w-]+)\.(?:png|webp)\)", page))
    made = {Path(output_of(words)).stem for words in pictures}
    if shown != made:
        print("docs/gallery.md: pictures without a command, or commands without a picture:", ", ".join(sorted(shown ^ made)))
        return 1
    pictures = [words for words in pictures if given.word in Path(output_of(words)).stem]
    for words in pictures:
        if (kind := movie_format(words)) and not given.update:
            kept = ROOT / "docs" / "pictures" / f"{Path(output_of(words)).name}.{kind}"
            if not kept.exists() or kept.stat().st_size > MOST_BYTES:
                print(f"{kept.relative_to(ROOT)} is missing, or larger than {MOST_BYTES} bytes")
                return 1
    pictures = [words for words in pictures if given.update or not movie_format(words)]
    needed = {word for words in pictures for word in words if word.endswith(".h5")}

    work = Path(given.work) if given.work else Path(tempfile.mkdtemp(prefix="gallery-"))
    folder = work / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    if not (work / "scenes").exists():
        (work / "scenes").symlink_to(ROOT / "scenes")

    def run(words):
        print("tanktread", shlex.join(words[1:]), file=sys.stderr, flush=True)
        done = subprocess.run([program, *words[1:], "-q"], cwd=work, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{shlex.join(words)}: {done.stderr.strip()}")

    for words in simulations:
        if output_of(words) in needed and not (work / output_of(words)).exists():
            run(words)
    changed = []
    for words in pictures:
        run(words)
        kind = movie_format(words)
        name = Path(output_of(words)).stem + (f".{kind}" if kind else ".png")
        drawn, kept = folder / name, ROOT / "docs" / "pictures" / name
        if kind:
            drawn = folder / Path(output_of(words)).name / f"movie.{kind}"
        if given.update:
            shutil.copyfile(drawn, kept)
            continue
        # Text differs a little between versions of Cairo and FreeType, so the eye's measure is taken.
        # Where a streamline ends may hang on the last digit: there the mean alone counts.
        rule = ["--preset", "perceptual"] + (["--flip-max", "1"] if "streamlines" in name else [])
        report = subprocess.run([program, "compare", str(kept), str(drawn), *rule], capture_output=True, text=True)
        if report.returncode != 0:
            changed.append(name)
            print((report.stdout + report.stderr).strip())
    if not given.work:
        if changed:
            print(f"the pictures are in {folder}")
        else:
            shutil.rmtree(work)
    return 1 if changed else 0


sys.exit(main())

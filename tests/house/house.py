#!/usr/bin/env python3
"""Tests of the house itself: layering, generated pages, commands in the README. One sentence per finding, status 1."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODULES = ["sim", "render", "app"]
# What the pictures may know of the simulation: values and how they are sampled, never operators or steppers.
RENDER_SEES = {"sim/core", "sim/trajectory/trajectory.h", "sim/sphere", "sim/surface/geometry.h"}
HDF5_FILES = re.compile(r"sim/trajectory/")
GL_FILES = re.compile(r"render/gl/context\w*\.(h|cpp)$")
GL_WORDS = re.compile(r"\bOSMesa[A-Z]\w*|\begl[A-Z]\w*\s*\(|<EGL/|<GL/osmesa")


def listed_files(module):
    """Files of a module in reading order, that of its folders and then of their lists: "sim/core/types.h", ..."""
    files = []
    for folder in re.findall(r"add_subdirectory\((\w+)\)", (ROOT / module / "CMakeLists.txt").read_text()):
        text = (ROOT / module / folder / "CMakeLists.txt").read_text()
        body = re.sub(r"#.*", "", re.search(r"target_sources\(\w+ PRIVATE\s(.*?)\)", text, re.S).group(1))
        files += [f"{module}/{folder}/{word}" for word in body.split() if re.fullmatch(r"\w+\.(h|cpp)", word)]
    return files + (["app/main.cpp"] if module == "app" else [])


def includes(path):
    return re.findall(r'^\s*#include\s+["<]([^">]+)[">]', path.read_text(), re.M)


def layering():
    findings = []
    order = {}
    for module in MODULES:
        for name in listed_files(module):
            order[name] = len(order)
        present = {str(p.relative_to(ROOT)) for p in (ROOT / module).rglob("*") if p.suffix in (".h", ".cpp")}
        listed = {name for name in order if name.startswith(module + "/")}
        findings += [f"{name} is not listed in the CMakeLists.txt of its folder" for name in sorted(present - listed)]
        findings += [f"a list of {module} names {name}, which does not exist" for name in sorted(listed - present)]
    for name in order:
        if not (ROOT / name).exists():
            continue
        module = name.split("/")[0]
        text = (ROOT / name).read_text()
        for include in includes(ROOT / name):
            if include in order and order[include] > order[name]:
                findings.append(f"{name} includes {include}, which stands below it")
            if include.split("/")[0] in MODULES and include not in order:
                findings.append(f"{name} includes {include}, which does not exist")
            if "/" not in include and (ROOT / name).parent.joinpath(include).exists():
                findings.append(f"{name} includes {include} without its folder")
            seen = include in RENDER_SEES or include.rsplit("/", 1)[0] in RENDER_SEES
            if module == "render" and include.startswith("sim/") and not seen:
                findings.append(f"{name} includes {include}: pictures see only {', '.join(sorted(RENDER_SEES))}")
            if include == "hdf5.h" and not HDF5_FILES.match(name):
                findings.append(f"{name} includes hdf5.h, which only the trajectory may")
        words = GL_WORDS.search(text)
        if words and not GL_FILES.match(name):
            findings.append(f"{name} mentions '{words.group(0)}', which only render/gl/context* may")
    return findings + frameworks()


def frameworks():
    """Tests reach Catch2 through the one header that knows its versions."""
    return [f"{path.relative_to(ROOT)} includes <{include}>: tests/support/catch.h serves with every version of Catch2"
            for path in sorted((ROOT / "tests").rglob("*")) if path.suffix in (".h", ".cpp") and path.parent.name != "support"
            for include in includes(path) if include.startswith("catch2/")]


def reference(program):
    page = ROOT / "docs" / "reference.md"
    command = f"{Path(program).name} list parameters --markdown"
    current = subprocess.run([program, "list", "parameters", "--markdown"], capture_output=True, text=True, check=True).stdout
    if not page.exists():
        return [f"docs/reference.md is missing; write it with: {command} > docs/reference.md"]
    if page.read_text() == current:
        return []
    pairs = zip(page.read_text().splitlines() + [""], current.splitlines() + [""])
    line = next((k for k, (old, new) in enumerate(pairs, 1) if old != new), 0)
    return [f"docs/reference.md:{line} is not what the program declares; renew it with: {command} > docs/reference.md"]


def commands_in(text):
    """(line, command) of every call of the program in a page: in fenced blocks, and between backticks in a line."""
    found = []
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        for code in [line] if fenced else re.findall(r"`([^`]+)`", line):
            found += [(number, word) for word in re.findall(r"(?:^|[\s/;|&(])tanktread(?:\.sh)? ([a-z][\w-]*)", code)]
    return found


def itself():
    """The checks of pages find what they are for."""
    page = "Call `tanktread rum x`, not tanktread rom.\n\n```\n$ ./tanktread.sh rem a\nbuild/release/tanktread run b | tanktread ram\n```\n`tanktread run`\n"
    expected = [(1, "rum"), (4, "rem"), (5, "run"), (5, "ram"), (7, "run")]
    found = commands_in(page)
    wrong = [] if found == expected else [f"commands of a page: {found}, not {expected}"]
    page = "## A\n| 1 |\n![a](a.png)\n### B\n| 2 |\n![b](b.png)\n### C\n| 3 |\n![c](c.png)\n"
    texts = {"a.png": "caption\n| 1 |\n", "b.png": "| 1 |\n"}
    findings = validation_findings(page, lambda picture: {"tanktread:tables": texts[picture]} if picture in texts else {})
    if [("b.png" in f, "c.png" in f) for f in findings] != [(True, False), (False, True)]:
        wrong.append(f"pictures of a page: {findings}")
    return wrong


def pages(program):
    """Every command line in README.md and docs/ names a command that exists and scenes that are there."""
    help_text = subprocess.run([program, "--help"], capture_output=True, text=True, check=True).stdout
    commands = set(re.findall(r"^  (\w+)\s", re.split("^subcommands:", help_text, flags=re.M | re.I)[1], re.M)) | {"test"}
    findings = []
    files = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
    for path in files:
        name = path.relative_to(ROOT)
        if not path.exists():
            findings.append(f"{name} is missing")
            continue
        findings += [f"{name}:{number} names the command '{word}', which does not exist"
                     for number, word in commands_in(path.read_text()) if word not in commands]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            for scene in re.findall(r"\bscenes/[\w.-]+\.toml", line):
                if not (ROOT / scene).exists():
                    findings.append(f"{name}:{number} names {scene}, which does not exist")
            for target in re.findall(r"\]\((?!https?:|#)([^)#\s]+)", line):
                if not (path.parent / target).exists():
                    findings.append(f"{name}:{number} points to {target}, which does not exist")
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    if f"\nversion: {version}\n" not in (ROOT / "CITATION.cff").read_text():
        findings.append(f"CITATION.cff does not name version {version}")
    if files[0].exists():
        text = files[0].read_text()
        for needed in ("./tanktread.sh run", "./tanktread.sh test"):
            if needed not in text:
                findings.append(f"README.md does not name the command '{needed}'")
    return findings


def png_texts(path):
    """Keys and texts of a PNG file's uncompressed text chunks."""
    data = path.read_bytes()
    texts = {}
    at = 8
    while at + 8 <= len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        if kind in (b"tEXt", b"iTXt"):
            key, text = body.split(b"\0", 1)
            if kind == b"iTXt":  # two bytes on compression, then language and translated key
                text = text[2:].split(b"\0", 2)[2]
            texts[key.decode()] = text.decode()
        at += 12 + length
    return texts


def validation_findings(page, text_of):
    """Every picture of the page stands in a section with the very tables that were computed with it."""
    findings = []
    for section in re.split(r"^(?=#{2,3} )", page, flags=re.M):
        for picture in re.findall(r"^!\[.*?\]\((\S+\.png)\)", section, re.M):
            made = [line for line in text_of(picture).get("tanktread:tables", "").splitlines() if line.startswith("|")]
            shown = [line for line in section.splitlines() if line.startswith("|")]
            if not made:
                findings.append(f"docs/validation.md: {picture} does not tell the tables that it was made with")
            elif made != shown:
                line = next((b or a for a, b in zip(made + [""], shown + [""]) if a != b), "")
                findings.append(f"docs/validation.md: {picture} was made with other numbers than the page shows beside it: {line}")
    return findings


def validation():
    page = ROOT / "docs" / "validation.md"
    return validation_findings(page.read_text(), lambda picture: png_texts(page.parent / picture))


def layout():
    """C++ files are as clang-format leaves them. Its versions differ in details: one is the measure."""
    version = "14"
    names = [name for name in (f"clang-format-{version}", "clang-format") if shutil.which(name)]
    said = subprocess.run([names[0], "--version"], capture_output=True, text=True).stdout if names else ""
    if f"version {version}." not in said:
        print(f"clang-format {version} is not here: the layout of lines is not checked")
        sys.exit(77)
    files = [path for module in [*MODULES, "tests"] for path in sorted((ROOT / module).rglob("*")) if path.suffix in (".h", ".cpp")]
    findings = []
    for first in range(0, len(files), 50):
        done = subprocess.run([names[0], "--dry-run", "--ferror-limit=1", *map(str, files[first:first + 50])],
                              capture_output=True, text=True)
        findings += [f"{Path(line.split(':')[0]).relative_to(ROOT)}:{line.split(':')[1]} is not laid out by .clang-format: "
                     "clang-format -i lays it out" for line in done.stderr.splitlines() if "-Wclang-format-violations" in line]
    return findings


def main():
    checks = {"validation": validation, "layering": layering, "layout": layout, "reference": reference, "pages": pages,
              "itself": itself}
    findings = checks[sys.argv[1]](*sys.argv[2:])
    for finding in findings:
        print(finding)
    return 1 if findings else 0


sys.exit(main())

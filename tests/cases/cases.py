#!/usr/bin/env python3
"""What the program does at small inputs that are simple, hostile or unusual, seen from the command line.

cases.py PROGRAM        runs all cases and prints a line each; the last line counts them; status 1 when one failed
cases.py PROGRAM NAME   runs one; status 77 when it cannot be tried here
"""

import csv
import io
import json
import math
import os
import resource
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time
import xml.dom.minidom
import zlib
from pathlib import Path

CASES = []
FAULTS = Path(__file__).resolve().parents[1] / "faults"
PATIENCE = 120  # seconds for one command: far more than it needs, also with sanitizers

SHEAR = '[flow]\nkind = "shear"\n'
REST = '[flow]\nkind = "none"\n'
SMALL_VIEW = "[view]\nsize = [64, 48]\nsupersampling = 1\n"


class Failed(Exception):
    pass


class Skipped(Exception):
    pass


def case(name):
    def add(function):
        CASES.append((name, function))
        return function
    return add


def check(true, reason):
    if not true:
        raise Failed(reason)


def near(value, expected, tolerance, what):
    check(abs(value - expected) <= tolerance, f"{what} is {value!r}, expected {expected!r} within {tolerance:g}")


# Scenes.


def vesicle(shape="prolate", reduced_volume=0.9, order=4, more=""):
    volume = "" if shape in ("sphere", "file") else f"reduced_volume = {reduced_volume}\n"
    return f'[[vesicle]]\nshape = "{shape}"\n{volume}order = {order}\n{more}'


def times(end, step=0.1, save_every=None):
    return f"[time]\nend = {end}\nstep = {step}\n" + (f"save_every = {save_every}\n" if save_every else "")


SMALL = SHEAR + times(0.3) + vesicle() + SMALL_VIEW
OVERLAP = SHEAR + times(0.3) + vesicle() + vesicle(more="center = [0.5, 0, 0]\n") + SMALL_VIEW


# The program.


class Result:
    def __init__(self, status, out, err):
        self.status, self.out_bytes, self.err_bytes = status, out, err
        self.out, self.err = out.decode(errors="replace"), err.decode(errors="replace")


class Desk:
    """A folder of its own in which the program is called."""

    def __init__(self, program, folder):
        self.program, self.folder = program, Path(folder)

    def __truediv__(self, name):
        return self.folder / name

    def write(self, name, content):
        path = self / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def start(self, *words, environment=None, memory=None):
        limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory))) if memory else None
        return subprocess.Popen([self.program, *map(str, words)], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, env={**os.environ, **(environment or {})}, preexec_fn=limit)

    def run(self, *words, environment=None, memory=None, patience=PATIENCE):
        process = self.start(*words, environment=environment, memory=memory)
        try:
            out, err = process.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            raise Failed(f"'{' '.join(map(str, words))}' did not end in {patience} s")
        return Result(process.returncode, out, err)

    def good(self, *words, **more):
        result = self.run(*words, **more)
        check(result.status == 0, f"'{' '.join(map(str, words))}' ended with status {result.status}: {result.err.strip()[:200]}")
        return result

    def refused(self, *words, says="", status=None, **more):
        """One sentence and a status that is neither 0 nor a crash."""
        result = self.run(*words, **more)
        what = f"'{' '.join(map(str, words))}'"
        check(result.status in ((status,) if status else (1, 2)), f"{what} ended with status {result.status}: {result.err.strip()[:200]}")
        text = result.err + result.out
        check(text.strip(), f"{what} was refused without a word")
        check(says in text, f"{what} does not say '{says}': {text.strip()[:200]}")
        return result

    def simulate(self, scene, name="t.h5", *words, **more):
        self.write("s.toml", scene)
        return self.good("simulate", "s.toml", "-o", name, "--force", *words, **more)

    def table(self, name="t.h5"):
        rows = csv.DictReader(io.StringIO(self.good("export", name, "--csv", "-").out))
        return [{key: float(value) for key, value in row.items()} for row in rows]

    def states(self, scene, *words):
        self.simulate(scene, "states.h5", "-q", *words)
        return self.table("states.h5")

    def picture(self, trajectory, name, *words):
        self.good("render", trajectory, "-o", name, "-q", *words)
        return Picture(self / name)

    def tree(self, name):
        top = self / name
        return {str(p.relative_to(top)): p.read_bytes() for p in sorted(top.rglob("*")) if p.is_file()}


def h5py():
    try:
        import h5py as module
    except ImportError:
        raise Skipped("no h5py here")
    return module


def checksum(row, content):
    return (1 << 32) + zlib.crc32(struct.pack("<Q", row) + content)


def sanitized(program):
    return b"__asan_init" in Path(program).read_bytes()


def preloaded(desk, name):
    """The library of that name in tests/faults, built or to be built."""
    if sanitized(desk.program):
        raise Skipped("libraries cannot be preloaded under sanitizers")
    built = Path(desk.program).resolve().parent / "tests" / "faults" / f"{name}.so"
    if built.exists():
        return str(built)
    compiler = shutil.which("c++") or shutil.which("g++")
    if not compiler:
        raise Skipped("no C++ compiler here")
    library = desk / f"{name}.so"
    subprocess.run([compiler, "-std=c++20", "-shared", "-fPIC", "-o", library, FAULTS / f"{name}.cpp", "-ldl"], check=True)
    return str(library)


# Pictures.


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(width, height, pixel, samples=3, before=b"", after=b""):
    """pixel: a colour, or a function of x, y; `before`, `after`: more chunks round the image."""
    if callable(pixel):
        rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
        packed = zlib.compress(rows)
    else:
        packer = zlib.compressobj(1)
        row = b"\0" + bytes(pixel) * width
        packed = b"".join(packer.compress(row) for _ in range(height)) + packer.flush()
    head = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[samples], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + before + chunk(b"IDAT", packed) + after + chunk(b"IEND", b"")


RED, BLUE = (255, 0, 0), (0, 0, 255)


def chunks_of(content):
    at, found = 8, []
    while at < len(content):
        size, kind = struct.unpack(">I4s", content[at:at + 8])
        found.append((kind, content[at + 8:at + 8 + size]))
        at += 12 + size
    return found


class Picture:
    """An 8 bit PNG without interlace, as the program writes it."""

    def __init__(self, path):
        chunks = chunks_of(Path(path).read_bytes())
        self.width, self.height, bits, kind = struct.unpack(">IIBB", chunks[0][1][:10])
        assert bits == 8 and kind in (2, 6), (bits, kind)
        self.samples = n = 3 if kind == 2 else 4
        data = zlib.decompress(b"".join(c for k, c in chunks if k == b"IDAT"))
        stride, previous, self.rows = self.width * n, bytearray(self.width * n), []
        for y in range(self.height):
            at = y * (stride + 1)
            how, row = data[at], bytearray(data[at + 1:at + 1 + stride])
            for i in range(stride if how else 0):
                a, b, c = (row[i - n], previous[i], previous[i - n]) if i >= n else (0, previous[i], 0)
                if how == 1:
                    guess = a
                elif how == 2:
                    guess = b
                elif how == 3:
                    guess = (a + b) // 2
                else:
                    p = a + b - c
                    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                    guess = a if pa <= pb and pa <= pc else b if pb <= pc else c
                row[i] = (row[i] + guess) & 255
            self.rows.append(row)
            previous = row

    def __call__(self, x, y):
        return tuple(self.rows[y][x * self.samples:x * self.samples + 3])

    def where(self, question, left=0.0, right=1.0, top=0.0, bottom=1.0):
        """The pixels within shares of the picture for which the answer is yes."""
        return [(x, y) for y in range(int(top * self.height), int(bottom * self.height))
                for x in range(int(left * self.width), int(right * self.width)) if question(*self(x, y))]


def colourful(r, g, b):
    return max(r, g, b) - min(r, g, b) > 60


# Motion.


@case("a sphere in shear turns rigidly without a warning")
def sphere_in_shear(desk):
    for contrast in (1, 10):
        scene = SHEAR + times(1, 0.1) + f"[[vesicle]]\norder = 4\nviscosity_contrast = {contrast}\n"
        result = desk.simulate(scene)
        check("warning" not in result.err, result.err.strip())
        for row in desk.table():
            # Area and volume are corrected to 1e-9 or so, and an excess area of e allows amplitudes of sqrt(e).
            near(row["energy"], 1, 1e-8, "the energy of the sphere")
            # |u| = |x sin| / 2: the integral of its square over the unit sphere is 2 pi / 3.
            near(row["velocity_l2"], math.sqrt(2 * math.pi / 3), 1e-6, "the speed of the sphere")
            # A sphere that gives way to the strain would have about 1.
            near(row["normal_velocity_l2"], 0, 1e-3, "the normal speed of the sphere")


@case("a uniform stream carries a viscous vesicle without changing it")
def galilean(desk):
    def last(flow, more=""):
        return desk.states(flow + times(0.5) + vesicle(reduced_volume=0.85, order=6, more="viscosity_contrast = 10\n" + more))[-1]

    for u in (1, 10, 100):
        here, rest = last(f'[flow]\nkind = "uniform"\nvelocity = [{u}, 0, 0]\n'), last(REST)
        near(here["center_x"], u * 0.5, 1e-9 * u, f"the place in a stream of {u}")
        for key in ("energy", "axis_1", "tension_mean"):
            near(here[key], rest[key], 1e-8, f"{key} in a stream of {u}")
    axis, far = last(SHEAR), last(SHEAR, "center = [0, 0, 20]\n")
    near(far["center_x"], 10, 1e-8, "the place 20 radii off the axis")
    for key in ("energy", "axis_1", "inclination_deg"):
        near(far[key], axis[key], 1e-7, f"{key} 20 radii off the axis")


@case("a vesicle of micrometres in metres gives the picture of one of radius 1")
def small_units(desk):
    for name, radius in (("one", 1.0), ("metres", 2.8e-6), ("tiny", 1e-12), ("huge", 1e12)):
        scene = SHEAR + times(0.1) + vesicle(more=f"radius = {radius}\nbending_modulus = {0.01 * radius**3!r}\n")
        desk.simulate(scene, name + ".h5", "-q")
        desk.good("render", name + ".h5", "--time", "0.1", "-o", name + ".png", "--size", "240x136", "--set", "view.inset=true", "-q")
        if name != "one":
            result = desk.run("compare", "one.png", name + ".png")
            check(result.status == 0, f"radius {radius:g}: {result.out.strip()}")


@case("two vesicles in metres move as they do in radii")
def gap_in_metres(desk):
    tables = []
    for radius in (1.0, 2.8e-6):
        size = f"radius = {radius}\nbending_modulus = {0.01 * radius**3!r}\n"
        scene = SHEAR + times(0.2) + vesicle(reduced_volume=0.95, more=size)
        scene += vesicle(reduced_volume=0.95, more=size + f"center = [0, 0, {2.857 * radius!r}]\n")
        tables.append((radius, desk.states(scene)))
    for one, other in zip(tables[0][1], tables[1][1]):
        near(other["inclination_deg"], one["inclination_deg"], 1e-6, "the inclination in metres")
        for key in ("center_x", "center_z"):
            near(other[key] / tables[1][0], one[key], 1e-7, key + " over the radius")


@case("a flow without a strength is told")
def no_flow(desk):
    for kind in ("poiseuille", "rotation", "uniform"):
        result = desk.simulate(f'[flow]\nkind = "{kind}"\n' + times(0.1) + vesicle(more="bending_modulus = 0\n"))
        moves = desk.table()[-1]["velocity_l2"] > 1e-3
        check(moves or ("warning" in result.err and kind in result.err), f"'{kind}' moves nothing, and nothing is said")


@case("a flow that is switched on acts from its time, neither earlier nor later")
def switched_on(desk):
    def rows(more, end):
        return desk.states(SHEAR + more + times(end, 0.1, 0.5) + vesicle(reduced_volume=0.85, more="axis = [1, 0, 0.3]\n"
                                                                       "viscosity_contrast = 3\nbending_modulus = 0\n"))
    late, now = rows('time_factor = "step"\nfrom = 0.5\n', 1.5), rows('time_factor = "step"\nfrom = 0\n', 1)
    near(late[1]["inclination_deg"], late[0]["inclination_deg"], 1e-9, "the inclination when the flow begins")
    for k in (1, 2):
        near(late[k + 1]["inclination_deg"], now[k]["inclination_deg"], 1e-6, f"the inclination {0.5 * k} after the flow began")


@case("the colour bar has heads where values lie beyond its range")
def bar_heads(desk):
    desk.simulate(SHEAR + times(1, 0.1, 1) + vesicle(reduced_volume=0.85, order=6), "t.h5", "-q")
    row = desk.table()[-1]
    least, most = (row[key] / 0.01 for key in ("tension_min", "tension_max"))  # over kappa_b / R0^2

    def ends(low, high):
        shown = desk.picture("t.h5", f"{low}_{high}.png", "--time", "1", "--style", "field", "--size", "480x270", "--set",
                             f"view.field_range=[{low}, {high}]", "--set", "view.zoom=0.5")
        ys = [y for _, y in shown.where(colourful, left=0.8)]
        check(ys, "there is no colour bar")
        return min(ys), max(ys)

    top, bottom = ends(math.floor(least / 2), math.ceil(2 * most))
    middle = (least + most) / 2
    inside = ends(0.9 * least + 0.1 * middle, 0.9 * most + 0.1 * middle)
    check(inside[0] < top - 2 and inside[1] > bottom + 2, "values beyond both ends, and not two heads")
    above = ends(-1, 0)
    check(above[0] < top - 2 and abs(above[1] - bottom) <= 1, "values above the range only, and not one head above")
    below = ends(math.ceil(2 * most), math.ceil(4 * most))
    check(below[1] > bottom + 2 and abs(below[0] - top) <= 1, "values below the range only, and not one head below")


@case("inf lifts a threshold of compare, and nan is none")
def compare_inf(desk):
    desk.write("a.png", png(64, 48, RED)), desk.write("b.png", png(64, 48, BLUE))
    lifted = desk.run("compare", "a.png", "b.png", "--rmse", "inf")
    check(lifted.status == 1 and "rmse" not in lifted.out.split(";")[0], f"--rmse inf: status {lifted.status}: {lifted.out}{lifted.err}")
    desk.good("compare", "a.png", "b.png", "--rmse", "inf", "--largest", "inf", "--pixels", "inf")
    for name in ("rmse", "pixels", "largest", "flip-mean", "flip-max", "ppd"):
        desk.refused("compare", "a.png", "b.png", "--preset", "perceptual", "--" + name, "nan", status=2, says="nan")
    desk.refused("compare", "a.png", "b.png", "--preset", "perceptual", "--ppd", "1e9", status=2)


@case("a picture called PNG in capitals is compared")
def upper_case(desk):
    for folder, colour in (("e", RED), ("a", BLUE)):
        desk.write(f"{folder}/x.PNG", png(64, 48, colour)), desk.write(f"{folder}/y.png", png(64, 48, RED))
    result = desk.run("compare", "e", "a")
    check(result.status == 1 and "x.PNG" in result.out, f"status {result.status}: {result.out.strip()}")


@case("the picture of a vesicle far from the origin is that of one at the origin")
def far_from_origin(desk):
    for place in ("0", "65536", "1e6", "1e8"):
        desk.simulate(REST + times(0.1) + vesicle(reduced_volume=0.85, more=f"center = [{place}, {place}, {place}]\n"), place + ".h5", "-q")
        desk.good("render", place + ".h5", "--time", "0.1", "-o", place + ".png", "--size", "320x180", "-q")
        result = desk.run("compare", "0.png", place + ".png")
        check(result.status == 0, f"at {place}: {result.out.strip()}")


@case("the inset holds the cross-sections of all vesicles")
def inset(desk):
    scene = SHEAR + times(1)
    for side in (-1, 1):
        scene += vesicle(reduced_volume=0.85, more=f"center = [{1.8 * side}, 0, {-0.4 * side}]\n")
    desk.simulate(scene, "t.h5", "-q", "--steps", "0")
    shown = desk.picture("t.h5", "p.png", "--time", "0", "--size", "640x360", "--set", "view.inset=true", "--set",
                         "view.background=\"white\"", "--set", "view.flow_arrows=false")
    # Each is a whole ellipse, nothing of it cut off by the frame: axes as of this prolate, 2.3 to 1, within a pixel or two.
    for word, question in (("first", lambda r, g, b: r > 230 and b < 225), ("second", lambda r, g, b: b > 230 and r < 225)):
        found = shown.where(question, left=0.75, bottom=0.23)
        check(found, f"the inset does not show the {word}")
        xs, ys = zip(*found)
        ratio = (max(xs) - min(xs) + 3) / (max(ys) - min(ys) + 3)
        check(2.1 < ratio < 2.6, f"the {word} is {ratio:.2f} times as long as high in the inset, so a part is missing")


@case("a finished run goes on to a later end, and what differs is named")
def extended(desk):
    desk.simulate(SHEAR + times(0.2) + vesicle(), "a.h5", "-q")
    desk.good("simulate", "s.toml", "-o", "a.h5", "--resume", "-q", "--set", "time.end=0.4")
    desk.good("simulate", "s.toml", "-o", "b.h5", "-q", "--set", "time.end=0.4")
    continued, whole = desk.table("a.h5"), desk.table("b.h5")
    check(len(continued) == len(whole) == 5, f"{len(continued)} states instead of {len(whole)}")
    # The last step before the earlier end is 0.1 up to rounding.
    for one, other in zip(continued, whole):
        for key in one:
            near(one[key], other[key], 1e-9, f"{key} of the continued run at t = {other['time']:g}")
    desk.refused("simulate", "s.toml", "-o", "a.h5", "--resume", "--set", "time.end=0.4", "--set", "flow.rate=2",
                 says="flow.rate is 1.0 there and 2.0 here")


@case("a search for places obeys the first signal, and one without hope is refused")
def placement(desk):
    def scene(radius, more):
        return SHEAR + times(1) + vesicle(more=f"radius = {radius}\n") + '[[placement]]\nkind = "box"\n' + more
    desk.write("hopeless.toml", scene(1e-6, "count = 20\nvolume_fraction = 0.1\ngap = 0.05\n"))
    desk.refused("simulate", "hopeless.toml", "-o", "t.h5", "--dry-run", patience=20)
    desk.write("long.toml", scene(1, "count = 4000\nvolume_fraction = 0.4\ngap = 0\n"))
    process = desk.start("simulate", "long.toml", "-o", "t.h5")  # a search for minutes
    time.sleep(1)
    if process.poll() is None:
        process.terminate()
        try:
            process.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            process.kill()
            raise Failed("the first SIGTERM does not end the search")
        check(process.returncode in (130, 143, -signal.SIGTERM), f"status {process.returncode} after SIGTERM")
    else:
        process.communicate()
        check(process.returncode == 1, f"the search ended with status {process.returncode} in a second")
    # The default gap is a share of the vesicle, whatever its unit.
    desk.write("metres.toml", scene(1e-6, "count = 4\nvolume_fraction = 0.1\n"))
    desk.good("simulate", "metres.toml", "-o", "m.h5", "--steps", "0", "-q")


@case("a time that is none is refused")
def time_nan(desk):
    desk.simulate(SMALL, "t.h5", "-q")
    for word in ("nan", "inf", "-inf", "-1", "1000"):
        desk.refused("render", "t.h5", "--time=" + word, "-o", "p.png")
        check(not (desk / "p.png").exists(), f"--time {word} has made a picture")


@case("a shape table keeps its own axes")
def table_axes(desk):
    desk.write("table.txt", "coefficients\n0 0 0 0 0\n1 -1 0 1.6 0\n1 0 0 0 1.6\n1 1 3 0 0\n")
    for axis, angle in (("", 0), ("axis = [0, 0, 1]\n", 0), ("axis = [1, 0, 0]\n", 90)):
        row = desk.states(REST + times(0) + vesicle("file", more='file = "table.txt"\n' + axis), "--steps", "0")[0]
        near(abs(row["inclination_deg"]), angle, 1e-6, f"the inclination with '{axis.strip()}'")


@case("rounding noise of fluid at rest is not drawn as a field")
def noise(desk):
    desk.simulate(REST + times(0.1) + "[[vesicle]]\norder = 4\n", "t.h5", "-q")
    desk.good("figure", "streamlines", "t.h5", "-o", "s", "-q", "--size", "400x300px")
    flow = Picture(desk / "s.png").where(lambda r, g, b: b > r + 30, right=0.68)  # beyond is the colour bar
    check(not flow, "there are streamlines in fluid at rest")
    for field in ("tension", "membrane-speed"):
        shown = desk.picture("t.h5", field + ".png", "--time", "0.1", "--style", "field", "--size", "240x136", "--set", f"view.field={field}")
        body = [shown(x, y) for x in range(80, 160) for y in range(28, 108) if (x - 120) ** 2 + (y - 68) ** 2 < 40 ** 2]
        # One colour under one light, white or the dark end of a map: the ratio of its red and blue stays.
        ratios = [r / (b + 1) for r, g, b in body if b > 30]
        check(len(ratios) > 2000, f"{field}: there is no body")
        check(max(ratios) - min(ratios) < 0.5, f"{field}: the body has stripes")


@case("numbers along an axis and a colour bar differ")
def tick_labels(desk):
    desk.simulate(REST + times(0) + vesicle(more="center = [1e8, 0, 1e8]\n"), "t.h5", "-q")
    desk.good("figure", "cross-sections", "t.h5", "-o", "c", "-q", "--set", "figure.times=[0]")
    root = xml.dom.minidom.parse(str(desk / "c.svg"))
    places = {}
    for node in root.getElementsByTagName("text"):
        text = "".join(t.data for n in [node, *node.getElementsByTagName("tspan")] for t in n.childNodes if t.nodeType == t.TEXT_NODE)
        if any(c.isdigit() for c in text) and "=" not in text:
            places.setdefault(text.strip(), []).append(text)
    numbers = [text for text in places if text.replace("−", "-").lstrip("-").replace(".", "").isdigit()]
    check(len(numbers) >= 4, f"the axes have hardly any numbers: {sorted(places)}")
    # x and z are the same here, so that a number may stand once at each axis.
    check(all(len(places[n]) <= 2 for n in numbers), f"a number stands more than once along an axis: {sorted(places)}")
    desk.simulate(REST + times(0) + vesicle(), "b.h5", "-q")
    shown = desk.picture("b.h5", "b.png", "--time", "0", "--style", "field", "--size", "640x360", "--set",
                         "view.field_range=[1000000, 1000001]", "--set", "view.zoom=0.4", "--set", "view.flow_arrows=false")
    bar = [x for x, _ in shown.where(colourful, left=0.75)]
    check(bar, "there is no colour bar")
    left = max(bar) + 6
    lines, current = [], []
    for y in range(shown.height // 4, shown.height):
        row = tuple(sum(shown(x, y)) < 500 for x in range(left, shown.width))
        if any(row):
            current.append(row)
        elif current:
            lines.append(tuple(current))
            current = []
    check(len(lines) >= 3, f"the bar has {len(lines)} numbers")
    check(len(set(lines)) == len(lines), "two numbers at the bar look the same")


@case("a wide outline lies close round its vesicle")
def wide_outline(desk):
    scene = SHEAR + times(1)
    for side in (-1, 1):
        scene += vesicle(reduced_volume=0.85, more=f"center = [{1.8 * side}, 0, {-0.4 * side}]\n")
    desk.simulate(scene, "t.h5", "-q", "--steps", "0")
    shown = desk.picture("t.h5", "p.png", "--time", "0", "--size", "640x360", "--set", "view.outline_width=20", "--set",
                         "view.tracers=false", "--set", "view.flow_arrows=false")
    looked = 0
    for x in range(int(0.02 * shown.width), int(0.98 * shown.width), 3):
        column = [shown(x, y) for y in range(int(0.2 * shown.height), int(0.9 * shown.height))]
        dark = [y for y, colour in enumerate(column) if max(colour) < 80]
        body = [y for y, colour in enumerate(column) if colourful(*colour)]
        if not dark or not body:
            continue
        looked += 1
        for a, b in ((dark[0], body[0]), (body[-1], dark[-1])):
            check(all(min(column[y]) < 215 for y in range(a, b)), f"there is a gap between membrane and outline at x = {x}")
    check(looked > 40, "there is hardly a vesicle with an outline")


@case("a figure of 85 mm says its size and holds text")
def figure_size(desk):
    desk.simulate(SMALL, "t.h5", "-q")
    desk.good("figure", "overlay", "t.h5", "-o", "o", "--size", "85mm", "-q")
    chunks = chunks_of((desk / "o.png").read_bytes())
    physical = [c for k, c in chunks if k == b"pHYs"]
    check(physical, "the PNG has no pHYs chunk")
    per_metre, _, unit = struct.unpack(">IIB", physical[0])
    width = struct.unpack(">I", chunks[0][1][:4])[0]
    check(unit == 1, "pHYs has no unit")
    near(1000 * width / per_metre, 85, 0.2, "the width in millimetres")
    check(b"<text" in (desk / "o.svg").read_bytes(), "the SVG has no text")
    if shutil.which("pdffonts"):
        out = subprocess.run(["pdffonts", desk / "o.pdf"], capture_output=True, text=True).stdout
        check(len(out.splitlines()) > 2, "the PDF has no font")


# Files.


@case("a trajectory appears where a link points")
def output_by_link(desk):
    (desk / "disk").mkdir()
    (desk / "a.h5").symlink_to("disk/a.h5")
    for turn in range(2):
        desk.simulate(SMALL, "a.h5", "-q")
        check((desk / "a.h5").is_symlink() and (desk / "disk/a.h5").is_file(), "the link was replaced")
        check(not (desk / "disk/a.h5").is_symlink(), "the file is a link")


@case("two names of one trajectory have one writer")
def two_writers(desk):
    desk.simulate(SHEAR + times(5000) + vesicle(order=6), "a.h5", "-q", "--steps", "2", "--set", "time.save_every=1")
    (desk / "b.h5").symlink_to("a.h5")
    os.link(desk / "a.h5", desk / "c.h5")
    words = ("simulate", "s.toml", "--resume", "-q", "--set", "time.save_every=1")
    before = (desk / "a.h5").stat().st_mtime_ns
    writer = desk.start(*words, "-o", "a.h5")
    try:
        for _ in range(600):
            if (desk / "a.h5").stat().st_mtime_ns != before or writer.poll() is not None:
                break
            time.sleep(0.1)
        check(writer.poll() is None, "the writer ended early")
        for name in ("a.h5", "b.h5", "c.h5"):
            desk.refused(*words, "-o", name, says="another process is writing", patience=20)
    finally:
        writer.send_signal(signal.SIGINT)
        writer.communicate(timeout=PATIENCE)


@case("a resumed run has the bytes of an uninterrupted one, notes included")
def note_after_resume(desk):
    # Just above the bound of the warning, again and again.
    result = desk.simulate(SHEAR + times(1.5) + vesicle(reduced_volume=0.85, order=6), "a.h5")
    check("does not resolve" in result.err, "this shape needs a warning, or the case says nothing")
    desk.good("simulate", "s.toml", "-o", "b.h5", "-q", "--steps", "7")
    desk.good("simulate", "s.toml", "-o", "b.h5", "-q", "--resume")
    check((desk / "a.h5").read_bytes() == (desk / "b.h5").read_bytes(), "the bytes differ")


@case("an array in the place of an attribute is told as damage by every command")
def attribute_array(desk):
    import_h5 = h5py()
    desk.simulate(SMALL, "t.h5", "-q")
    for name, value in (("format", [0x414141414141] * 8), ("vesicles", [0x414141414141] * 8), ("warnings", [b"A" * 64] * 700)):
        shutil.copy(desk / "t.h5", desk / "x.h5")
        with import_h5.File(desk / "x.h5", "r+") as file:
            del file.attrs[name]
            file.attrs[name] = value
        before = (desk / "x.h5").read_bytes()
        for words in (("info", "x.h5"), ("render", "x.h5", "-o", "r"), ("figure", "time-series", "x.h5", "-o", "f"),
                      ("export", "x.h5", "--csv", "-"), ("simulate", "s.toml", "-o", "x.h5", "--resume")):
            desk.refused(*words, says="damaged", status=1)
        check((desk / "x.h5").read_bytes() == before, "the damaged file was changed")


@case("a scene that cannot start is not deleted where it lies")
def scene_that_cannot_start(desk):
    desk.write("s.toml", SMALL)
    desk.good("run", "s.toml", "-o", "first", "-q")
    # As a run writes it, so that it is no other text than what a run here would write.
    resolved = (desk / "first/scene.toml").read_text()
    second = resolved[resolved.index("[[vesicle]]"):resolved.index("[numerics]")].replace("center = [0.0", "center = [0.5")
    scene = resolved.replace("[numerics]", second + "[numerics]", 1)
    path = desk.write("d/scene.toml", scene)
    for more in ((), ("--force",)):
        desk.refused("run", "d/scene.toml", "-o", "d", *more, says="overlap")
        check(path.exists() and path.read_text() == scene, "the scene is gone")
        check([p.name for p in (desk / "d").iterdir()] == ["scene.toml"], "something else was left")


@case("frames and movies of somebody else are neither replaced nor deleted")
def foreign_files(desk):
    names = [f"proj/frames/{n:06d}.png" for n in (0, 1, 2, 3, 4, 10, 500)] + ["proj/movie.mp4"]
    for name in names:
        desk.write(name, "precious " + name)
    desk.write("s.toml", SMALL)
    for more in ((), ("--force",)):
        desk.refused("run", "s.toml", "-o", "proj", "-q", *more)
        check(all((desk / n).read_text() == "precious " + n for n in names), "a file of somebody else was changed")
    desk.simulate(SMALL, "vids/t.h5" if (desk / "vids").mkdir() is None else "", "-q")
    desk.write("vids/movie.mp4", "wedding")
    desk.refused("render", "vids/t.h5", "-q")
    desk.run("render", "vids/t.h5", "-q", environment={"PATH": "/nonexistent"})
    check((desk / "vids/movie.mp4").read_text() == "wedding", "the movie of somebody else is gone")


@case("a scene that somebody wrote is never overwritten")
def hand_written_scene(desk):
    notes = "# MY NOTES: three weeks of tuning\n" + SMALL
    desk.write("proj/scene.toml", notes), desk.write("proj/variant.toml", SMALL + "[movie]\nframe_rate = 20\n")
    for scene in ("variant", "scene"):
        desk.refused("run", f"proj/{scene}.toml", "-o", "proj", "-q")
        check((desk / "proj/scene.toml").read_text() == notes, "the scene was overwritten")


@case("force takes nothing away for a scene that cannot start")
def force_of_a_bad_scene(desk):
    desk.write("good.toml", SMALL), desk.write("bad.toml", OVERLAP)
    desk.good("run", "good.toml", "-o", "out", "-q")
    before = desk.tree("out")
    desk.refused("run", "bad.toml", "-o", "out", "--force", says="overlap")
    check(desk.tree("out") == before, "results are gone or changed")


@case("a forged resume record is refused in one sentence")
def forged_record(desk):
    module = h5py()
    desk.simulate(SMALL, "t.h5", "-q")
    with module.File(desk / "t.h5", "r") as file:
        heads, whole = file["resume_head"][:], file["resume"][:]
    for s in range(2):
        assert checksum(int(heads[s, 0]), whole[s, :int(heads[s, 1])].tobytes()) == int(heads[s, 2]), "the format has changed"
    order = 12  # after version, step, saves, time, step limit, calm, five of the control, vesicles: order, rows, columns of the position, its numbers
    rows, columns = int(whole[0, order + 1]), int(whole[0, order + 2])
    past = order + 3 + rows * columns + 1  # behind the number of past levels
    assert whole[0, order] == whole[0, past] == 4, "the format has changed"
    for place in (order, order + 1, order + 2, past - 1, past, past + 1):
        for value in (1e6, 1e18, -1.0, float("nan")):
            shutil.copy(desk / "t.h5", desk / "x.h5")
            with module.File(desk / "x.h5", "r+") as file:
                for s in range(2):
                    numbers = whole[s, :int(heads[s, 1])].copy()
                    numbers[place] = value
                    file["resume"][s, :len(numbers)] = numbers
                    file["resume_head"][s, 2] = checksum(int(heads[s, 0]), numbers.tobytes())
            desk.refused("simulate", "s.toml", "-o", "x.h5", "--resume", "-q", "--set", "time.end=0.6", says="cannot be resumed", status=1,
                         patience=30)


@case("pipes and circles of links end in a sentence and not in waiting")
def pipes_and_circles(desk):
    picture = png(16, 12, RED)
    for name in ("e/x.png", "a/x.png", "e/y.png", "e2/x.png", "a2/x.png"):
        desk.write(name, picture)
    os.mkfifo(desk / "a/y.png")
    result = desk.run("compare", "e", "a", patience=20)
    check(result.status == 2 and "pipe" in result.out + result.err, f"a pipe among pictures: status {result.status}")
    for link in ("p", "q"):
        (desk / "e2" / link).symlink_to(".")
    result = desk.run("compare", "e2", "a2", patience=20)
    check(result.status == 0 and "1 picture" in result.out, f"links to '.': {result.out.strip()[-200:]}")
    os.mkfifo(desk / "pipe")
    desk.refused("info", "pipe", patience=20)
    module = h5py()
    desk.simulate(SMALL, "t.h5", "-q")
    with module.File(desk / "t.h5", "r+") as file:
        del file["time"]
        file["time"] = module.ExternalLink("pipe", "/time")
    desk.refused("info", "t.h5", says="damaged", patience=20)


# compare.


@case("thresholds that would pass everything are refused")
def foolish_thresholds(desk):
    desk.write("a.png", png(64, 48, RED)), desk.write("b.png", png(64, 48, BLUE))
    for words in ("--preset perceptual --ppd 1", "--preset perceptual --ppd 0", "--preset perceptual --ppd -5", "--rmse nan --pixels nan",
                  "--preset perceptual --flip-mean nan --flip-max nan", "--rmse -1"):
        desk.refused("compare", "a.png", "b.png", *words.split(), status=2)


@case("two ordinary names are two pictures and no alternatives")
def alternatives(desk):
    one, other = png(64, 48, RED), png(64, 48, BLUE)
    for folder in ("e", "a"):
        desk.write(f"{folder}/plot.png", one), desk.write(f"{folder}/plot.altitude.png", other)
        desk.write(f"{folder}/map.png", one), desk.write(f"{folder}/map.mask.png", other)
    result = desk.run("compare", "e", "a")
    check(result.status == 0 and "4 same" in result.out, f"status {result.status}: {result.out.strip()}")
    desk.write("a/plot.png", other)
    result = desk.run("compare", "e", "a")
    check(result.status == 1 and "different  plot.png" in result.out, "a wrong plot.png passes as plot.altitude.png")


@case("update takes nothing that is no picture")
def update_garbage(desk):
    desk.write("e/x.png", png(64, 48, RED)), desk.write("a/x.png", png(64, 48, RED)), desk.write("a/new.png", "no picture")
    result = desk.run("compare", "e", "a", "--update")
    check(result.status == 2 and "unreadable" in result.out, f"status {result.status}: {result.out.strip()}")
    check(not (desk / "e/new.png").exists(), "it was accepted")


@case("difference pictures never go among the compared ones")
def difference_folder(desk):
    one, other = png(64, 48, RED), png(64, 48, BLUE)
    desk.write("e/x.png", one), desk.write("a/x.png", other)
    for words in (("--diff", "e"), ("--diff", "a"), ("--diff", "a", "--update"), ("--diff", "./e/.")):
        desk.refused("compare", "e", "a", *words, status=2)
        check((desk / "e/x.png").read_bytes() == one and (desk / "a/x.png").read_bytes() == other, f"{words} changed a picture")


@case("reports stay well-formed whatever a file is called")
def report_names(desk):
    names = [b"<script>alert(1)<script>.png", b'"onload="alert(1).png', b"'><img src=x onerror=alert(1)>.png", b"new\nline\n::error::owned.png",
             b"esc\x1b[31m\x1b]0;pwn\x07.png", b"bad\xff\xfe.png", b"sur\xed\xa0\x80.png", b"over\xe0\x80\x80.png", b"big\xf4\x90\x80\x80.png",
             b"fffe\xef\xbf\xbe.png", b"c1\xc2\x9b31m.png", b"-rf.png", b"{{articles}}.png", b"cd]]>x.png", b"&amp;.png",
             b"bidi\xe2\x80\xaegnp.png", b"%s%n.png", b"{0}{}.png", b"tab\t.png", b"del\x7f.png"]
    for folder, colour in (("e", (10, 20, 30)), ("a", (200, 20, 30))):
        (desk / folder).mkdir()
        for name in names:
            Path(os.fsdecode(os.fsencode(desk / folder) + b"/" + name)).write_bytes(png(20, 20, colour))
    result = desk.run("compare", "e", "a", "--html", "rep", "--junit", "rep/j.xml")
    check(result.status == 1, f"status {result.status}: {result.err.strip()[:200]}")
    document = xml.dom.minidom.parse(str(desk / "rep/j.xml"))
    check(len(document.getElementsByTagName("testcase")) == len(names), "the JUnit report lacks pictures")
    listed = json.loads(desk.run("compare", "e", "a", "--json").out_bytes.decode("utf-8"))
    check(isinstance(listed, dict), "the JSON report is no object")
    page = (desk / "rep/index.html").read_bytes().decode("utf-8")
    check("<script>alert" not in page and "<img src=x" not in page, "a name gets into the page as a tag")
    text = result.out_bytes.decode("utf-8")
    check(not any(ord(c) < 32 and c != "\n" or 127 <= ord(c) < 160 for c in text), "control characters reach the terminal")
    check(not any(line.startswith("::") for line in text.splitlines()), "a name gives a command to the service")


@case("the same numbers that mean other colours are different")
def other_meaning(desk):
    def paint(x, y):
        return (4 * x % 256, 5 * y % 256, 90)

    profile = struct.pack(">I4sI4s4s4s", 132, b"test", 0x04000000, b"mntr", b"RGB ", b"XYZ ") + bytes(12) + b"acsp" + bytes(92)
    frame = struct.pack(">IIIIIHHBB", 0, 64, 48, 0, 0, 1, 10, 0, 0)
    second = struct.pack(">I", 1) + frame[4:]
    packed = zlib.compress(b"".join(b"\0" + bytes(64 * 3) for _ in range(48)))
    variants = {"gamma": dict(before=chunk(b"gAMA", struct.pack(">I", 100000))),
                "primaries": dict(before=chunk(b"cHRM", struct.pack(">8I", 31270, 32900, 15000, 6000, 30000, 60000, 64000, 33000))),
                "ICC": dict(before=chunk(b"iCCP", b"x\0\0" + zlib.compress(profile))),
                "animation": dict(before=chunk(b"acTL", struct.pack(">II", 2, 0)) + chunk(b"fcTL", frame),
                                  after=chunk(b"fcTL", second) + chunk(b"fdAT", struct.pack(">I", 2) + packed))}
    desk.write("plain.png", png(64, 48, paint))
    for word, chunks in variants.items():
        desk.write("other.png", png(64, 48, paint, **chunks))
        result = desk.run("compare", "plain.png", "other.png", "--preset", "exact")
        check(result.status == 1 and word in result.out, f"{word}: status {result.status}: {result.out.strip()}{result.err.strip()}")
        desk.good("compare", "other.png", "other.png", "--preset", "exact")


@case("a run killed at its end is finished to the same bytes by the next one")
def killed_at_the_end(desk):
    library = preloaded(desk, "killed_at")
    desk.write("s.toml", SMALL)
    desk.good("run", "s.toml", "-o", "whole", "-q", environment={"LD_PRELOAD": library, "COUNT_TO": str(desk / "count")})
    whole, count = desk.tree("whole"), int((desk / "count").read_text().split()[0])
    check(count > 20, f"only {count} changes of files were seen")
    # The beginning, where the scene is written; the end of the simulation, some way through; the end of everything.
    places = sorted({3, 5, 7, count // 4, count // 2, 2 * count // 3, 3 * count // 4, count - 1})
    kills = 0
    for place in places:
        killed = desk.run("run", "s.toml", "-o", "k", "-q", environment={"LD_PRELOAD": library, "KILL_AT": str(place)})
        # Resume records are renewed by the clock: a faster run has fewer changes, and may come to its end before the last places.
        check(killed.status in (-signal.SIGKILL, 0), f"killed at {place} of {count}: status {killed.status}")
        kills += killed.status != 0
        desk.good("run", "s.toml", "-o", "k", "-q")
        after = desk.tree("k")
        check(sorted(after) == sorted(whole), f"killed at {place} of {count}: other files: {sorted(set(after) ^ set(whole))}")
        check(after == whole, f"killed at {place} of {count}: other bytes: {[n for n in whole if whole[n] != after[n]]}")
        shutil.rmtree(desk / "k")
    check(kills > 4, f"only {kills} of {len(places)} runs were killed")


# Time dependence.


@case("an oscillation faster than the step is resolved or told")
def fast_oscillation(desk):
    scene = SHEAR + 'time_factor = "oscillating"\nfrequency = 10\n' + times(1, "STEP", 1) + vesicle(reduced_volume=0.85)
    fine = desk.states(scene.replace("STEP", "0.005"))[-1]["inclination_deg"]
    result = desk.simulate(scene.replace("STEP", "0.1"))
    check("warning" in result.err and "oscillat" in result.err, "a step of a period is not told")
    near(desk.table()[-1]["inclination_deg"], fine, 1e-3, "the inclination with a step of a period")


@case("a pulse shorter than the step acts")
def short_pulse(desk):
    scene = SHEAR + 'rate = 5\ntime_factor = "step"\nfrom = 0.31\nuntil = 0.39\n' + times(0.6, "STEP", 0.6) + vesicle(reduced_volume=0.85)
    fine, coarse = (desk.states(scene.replace("STEP", step))[-1]["inclination_deg"] for step in ("0.002", "0.1"))
    check(fine > 4, f"the pulse hardly acts with short steps: {fine}")
    # One step over the whole pulse begins at first order: its error is a share of the pulse.
    near(coarse, fine, 0.1 * fine, "the inclination after the pulse")


@case("an output that is an input or a trajectory is refused")
def output_over_input(desk):
    desk.simulate(SMALL, "t.h5", "-q")
    (desk / "link.h5").symlink_to("t.h5")
    before = (desk / "t.h5").read_bytes()
    for words in (("export", "t.h5", "--csv", "t.h5"), ("export", "link.h5", "--csv", "t.h5"), ("render", "t.h5", "--time", "0", "-o", "t.h5"),
                  ("render", "t.h5", "--time", "0", "-o", "t.h5", "--force"), ("simulate", "s.toml", "-o", "s.toml", "--force")):
        desk.refused(*words)
        check((desk / "t.h5").read_bytes() == before, f"'{' '.join(words)}' destroyed the trajectory")
    check((desk / "s.toml").read_text() == SMALL, "the scene was replaced")


@case("an inclination at a viscosity contrast of 1000 does not depend on the order")
def high_contrast(desk):
    angles = {}
    for order in (8, 12):
        scene = SHEAR + times(6, 0.1, 6) + vesicle(reduced_volume=0.85, order=order, more="viscosity_contrast = 1000\n")
        angles[order] = desk.states(scene)[-1]["inclination_deg"]
    near(angles[12], 32.8, 0.2, "the inclination at order 12")  # order 16 has this, the step being the same
    near(angles[8], angles[12], 0.05, "the inclination at order 8")


@case("one failed write is told or made good, and never a crash")
def failed_write(desk):
    library = preloaded(desk, "failing_files")
    desk.write("s.toml", SMALL)
    words = ("simulate", "s.toml", "-q")
    desk.good(*words, "-o", "whole.h5", environment={"LD_PRELOAD": library, "TANKTREAD_FAIL_COUNT": str(desk / "count")})
    whole, count = (desk / "whole.h5").read_bytes(), int((desk / "count").read_text())
    check(count > 10, f"only {count} changes of files were seen")
    told = 0
    for place in sorted({*range(1, count + 1, max(1, count // 16)), count}):
        (desk / "d").mkdir()
        failing = {"LD_PRELOAD": library, "TANKTREAD_FAIL_AT": str(place), "TANKTREAD_FAIL_HOW": "once"}
        result = desk.run(*words, "-o", "d/t.h5", environment=failing)
        check(result.status in (0, 1), f"operation {place} of {count} fails: status {result.status}")
        if result.status:
            told += 1
            check("No space left" in result.err, f"operation {place} of {count} fails: {result.err.strip()}")
            more = ("--resume",) if (desk / "d/t.h5").exists() else ()
            desk.good(*words, "-o", "d/t.h5", *more)
        check((desk / "d/t.h5").read_bytes() == whole, f"operation {place} of {count} failed: other bytes in the end")
        check([p.name for p in (desk / "d").iterdir()] == ["t.h5"], f"operation {place} of {count} failed: something was left")
        shutil.rmtree(desk / "d")
    check(told, "no failure was told")


@case("an opaque alpha channel does not dilute an error")
def alpha(desk):
    # A level in one sample of 40 of 3 each: rmse 0.158 of three samples, 0.137 of four; the bound of the default is 0.15.
    def paint(level, *more):
        return lambda x, y: (100 + level * ((y * 64 + x) % 40 < 1), 100 + level * ((y * 64 + x) % 40 < 1), 100 + level * ((y * 64 + x) % 40 < 1), *more)
    desk.write("r.png", png(64, 48, paint(0))), desk.write("r2.png", png(64, 48, paint(1)))
    desk.write("r2a.png", png(64, 48, paint(1, 255), samples=4))
    plain, with_alpha = (desk.run("compare", "r.png", name) for name in ("r2.png", "r2a.png"))
    check(plain.status == 1, f"the pictures are too much alike: {plain.out.strip()}")
    check(with_alpha.status == 1, f"saved with alpha: {with_alpha.out.strip()}")
    check(plain.out.replace("r2.png", "r2a.png") == with_alpha.out, f"{plain.out.strip()} / {with_alpha.out.strip()}")


@case("two large pictures are compared in the memory of the two")
def perceptual_memory(desk):
    if sanitized(desk.program):
        raise Skipped("memory cannot be limited under sanitizers")
    # 36 megapixels, 108 MB each; a map of a few floats for each pixel would be 2 GB.
    side = 6000
    desk.write("a.png", png(side, side, (90, 120, 150))), desk.write("b.png", png(side, side, (90, 120, 151)))
    result = desk.run("compare", "a.png", "b.png", "--preset", "perceptual", memory=1000 << 20)
    check(result.status in (0, 1, 2), f"status {result.status}: {result.err.strip()[:200]}")
    check("bad_alloc" not in result.out + result.err, "the sentence is a library's")
    check(result.status == 0, f"status {result.status}: {result.out.strip()}{result.err.strip()}")


@case("control characters of a title reach neither a terminal nor a scene")
def titles(desk):
    def lines(text):
        return [c for c in text if (ord(c) < 32 and c not in "\n\t") or 127 <= ord(c) < 160]

    desk.write("esc.toml", 'title = "a\\u001b]0;PWNED\\u0007\\u001b[2Jred\\nsecond = 1\\r\\u0008\\u009b31m"\n' + SMALL)
    for words in (("info", "esc.toml"), ("run", "esc.toml", "-o", "none", "--dry-run"), ("simulate", "esc.toml", "-o", "t.h5"),
                  ("info", "t.h5"), ("render", "t.h5", "--time", "0", "-o", "p.png"), ("info", "p.png")):
        result = desk.good(*words)
        check(not lines(result.out + result.err), f"'{' '.join(words)}' prints control characters")
    desk.write("out.toml", SMALL + '[[figure]]\nout = "x\\u001b[31m\\ny"\n')
    result = desk.refused("run", "out.toml", "-o", "none", "--dry-run")
    check(not lines(result.out + result.err), "a name of a figure brings control characters to the terminal")
    title = "harmless\\n[numerics]\\ncorrection = false\\n[flow]\\nkind='shear'\\nrate = 9.0\\n[[vesicle]]\\n"
    desk.write("inj.toml", f'title = "{title}"\n' + SMALL)
    dry = desk.good("run", "inj.toml", "-o", "none", "--dry-run").out
    desk.write("dry.toml", dry)
    again = desk.good("run", "dry.toml", "-o", "none", "--dry-run").out
    check(again == dry, "what --dry-run prints is another scene")
    check("\nrate = 1.0" in dry and "\nrate = 9.0" not in dry, "the title changes the scene")


@case("nothing is written through links out of a folder of results")
def links_in_results(desk):
    desk.write("s.toml", SMALL)
    desk.write("victim/a", "precious")
    (desk / "out/frames").mkdir(parents=True)
    (desk / "out/frames/000000.png").symlink_to("../../victim/a")
    desk.refused("run", "s.toml", "-o", "out", "-q")
    check((desk / "victim/a").read_text() == "precious", "a frame was written through a link")
    desk.simulate(SMALL, "t.h5", "-q")
    for name in ("000000", "000777"):
        desk.write(f"pics/{name}.png", "mine " + name)
    (desk / "o3").mkdir()
    (desk / "o3/frames").symlink_to("../pics")
    desk.refused("render", "t.h5", "-o", "o3", "-q")
    check({n: c for n, c in desk.tree("pics").items()} == {f"{n}.png": b"mine " + n.encode() for n in ("000000", "000777")},
          "pictures behind a linked folder were changed")
    desk.write("e/keep.png", png(8, 8, RED)), desk.write("a/x.png", png(8, 8, BLUE)), desk.write("a/keep.png", png(8, 8, RED))
    desk.write("victim/x.png", png(8, 8, RED))
    (desk / "e/x.png").symlink_to("../victim/x.png")
    desk.run("compare", "e", "a", "--update")
    check((desk / "victim/x.png").read_bytes() == png(8, 8, RED), "compare --update wrote through a link")


@case("devices, pipes and drafts of somebody else stay what they are")
def devices(desk):
    desk.write("s.toml", SMALL)
    device = desk / "null"
    if os.geteuid() == 0:  # who could replace it
        try:
            os.mknod(device, 0o666 | stat.S_IFCHR, os.makedev(1, 3))
        except PermissionError:
            device = None
    else:
        device = Path("/dev/null")
    os.mkfifo(desk / "pipe")
    for place in filter(None, (device, desk / "pipe")):
        kind = stat.S_IFMT(place.stat().st_mode)
        for more in ((), ("--force",)):
            desk.refused("simulate", "s.toml", "-o", place, "-q", *more, patience=20)
            check(stat.S_IFMT(place.stat().st_mode) == kind, f"'{place.name}' was replaced")
    names = ("u.h5.tmp", "u.h5.lock", "movie.mp4.keep.tmp", ".000001.png.17.tmp")
    for name in names:
        desk.write(name, "mine")
    desk.good("simulate", "s.toml", "-o", "u.h5", "-q", "--force")
    desk.good("render", "u.h5", "-q")
    check(all((desk / n).read_text() == "mine" for n in names), "a draft of somebody else is gone")


@case("a scene with fewer vesicles than its states is damage")
def fewer_vesicles(desk):
    module = h5py()
    desk.simulate(SHEAR + times(0.2) + vesicle() + vesicle(more="center = [0, 0, 4]\n") + SMALL_VIEW, "t.h5", "-q")
    with module.File(desk / "t.h5", "r+") as file:
        length = file["scene"].dtype.itemsize
        text = file["scene"][()]
        assert int(file.attrs["scene_checksum"]) in (checksum(0, text.ljust(length, b"\0")), checksum(length, text)), "the format has changed"
        row = 0 if int(file.attrs["scene_checksum"]) == checksum(0, text.ljust(length, b"\0")) else length
        first, second = text.index(b"[[vesicle]]"), text.rindex(b"[[vesicle]]")
        assert first != second
        changed = (text[:second] + text[text.index(b"[numerics]"):]).ljust(length, b"\n")
        file["scene"][()] = changed
        kind = file.attrs["scene_checksum"].dtype
        file.attrs.modify("scene_checksum", kind.type(checksum(row, changed)))
    for words in (("figure", "time-series", "t.h5", "-o", "f"), ("render", "t.h5", "-o", "r"), ("simulate", "s.toml", "-o", "t.h5", "--resume")):
        desk.refused(*words, says="its scene has 1", status=1)
    # The states alone are whole: who needs no scene may read them.
    for words in (("export", "t.h5", "--csv", "-"), ("info", "t.h5")):
        result = desk.run(*words)
        check(result.status in (0, 1), f"{words[0]}: status {result.status}")


@case("two figures of one name are refused")
def one_name(desk):
    for scene in ('[[figure]]\nkind = "cross-sections"\npanels = 1\n[[figure]]\nkind = "cross-sections"\npanels = 2\n',
                  '[movie]\nposter = 0\n[[figure]]\nkind = "cross-sections"\nout = "poster"\npanels = 1\n'):
        desk.write("s.toml", SMALL + scene)
        desk.refused("run", "s.toml", "-o", "out", "-q", says="another 'out'")
        check(not (desk / "out").exists(), "something was made before it was refused")


def attempt(program, name, function):
    """The word for what came of it, and why."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            function(Desk(program, folder))
        except Skipped as reason:
            return "skipped", str(reason)
        except Failed as reason:
            return "FAILED", str(reason)
        except Exception as error:  # of the case itself, and no less a failure
            return "FAILED", f"{type(error).__name__}: {error} (line {error.__traceback__.tb_next.tb_lineno})"
    return "ok", ""


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    program, wanted = str(Path(sys.argv[1]).resolve()), sys.argv[2:]
    chosen = [(name, function) for name, function in CASES if not wanted or name == wanted[0]]
    if not chosen:
        sys.exit(f"there is no case '{wanted[0]}'")
    counts = {"ok": 0, "FAILED": 0, "skipped": 0}
    for name, function in chosen:
        word, reason = attempt(program, name, function)
        counts[word] += 1
        print(f"{word} {name}" + (": " + " ".join(reason.split()) if reason else ""), flush=True)
    print(f"{counts['ok']} passed, {counts['FAILED']} failed" + (f", {counts['skipped']} skipped" if counts["skipped"] else ""))
    if counts["FAILED"]:
        sys.exit(1)
    sys.exit(77 if wanted and counts["skipped"] else 0)


if __name__ == "__main__":
    main()

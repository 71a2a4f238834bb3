#!/usr/bin/env python3
"""A trajectory is an ordinary HDF5 file: what docs/trajectory.md shows in Python works. h5py_reads.py PROGRAM SCENE."""

import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

try:
    import h5py
    import numpy
except ImportError:
    sys.exit(77)  # skipped

program, scene = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "t.h5"
    subprocess.run([program, "simulate", scene, "-o", path, "--steps", "3", "--quiet"], check=True)
    with h5py.File(path, "r") as file:
        count = int(file["count"][()])
        assert count >= 1
        assert file.attrs["format"] == 3
        assert b"[time]" in file["scene"][()]
        position = file["position"][:count]
        order = int(file["order"][0, 0])
        rows = (order + 1) ** 2
        assert position.shape[1:3] == (1, 3) and position.shape[3] >= rows
        assert numpy.isfinite(position).all() and abs(position[0, 0, :, 1:4]).max() > 0.1
        steps = int(file["steps/count"][()])
        assert steps >= 3 and list(file["steps/step"][:steps]) == list(range(1, steps + 1))
        assert all(file[name].attrs["meaning"] for name in file if name != "steps")
        # The checksum of the first step record: row number, then its numbers in the order of the file.
        names = sorted((n for n in file["steps"] if n not in ("count", "checksum")), key=lambda n: file["steps"][n].id.get_offset())
        row = numpy.uint64(0).tobytes() + b"".join(file["steps"][n][0].tobytes() for n in names)
        assert int(file["steps/checksum"][0]) == (1 << 32) + zlib.crc32(row)

    # The example of the page: the angle by which a rotating fluid carries a vesicle round is rate x time.
    page = (Path(__file__).resolve().parents[2] / "docs" / "trajectory.md").read_text()
    example = page.split("## An angle in ten lines")[1].split("```python\n")[1].split("```")[0]
    assert len(example.strip().splitlines()) <= 10

    class NoPlot:
        def __getattr__(self, name):
            return self if name == "pyplot" else lambda *words, **more: None

    sys.modules["matplotlib"] = sys.modules["matplotlib.pyplot"] = NoPlot()
    turning = Path(folder) / "turning.toml"
    turning.write_text('[flow]\nkind = "rotation"\nangular_velocity = [0, 2, 0]\n[time]\nend = 0.5\nstep = 0.05\n'
                       '[[vesicle]]\nshape = "prolate"\nreduced_volume = 0.95\norder = 6\n')
    subprocess.run([program, "simulate", turning, "-o", Path(folder) / "turning.h5", "--quiet"], check=True)
    values = {}
    exec(example.replace("out/trajectory.h5", str(Path(folder) / "turning.h5")), values)
    times = values["file"]["time"][: values["n"]]
    # The steps are of second order; the prolate relaxes a little while it turns.
    assert abs(values["angle"] - 2 * times).max() < 0.01, (values["angle"], 2 * times)

    # Files of a later version and of other programs are refused in one sentence, and left as they are.
    def refusal(change, name):
        other = Path(folder) / name
        other.write_bytes(path.read_bytes())
        change(other)
        before = other.read_bytes()
        for words in (["info", other], ["simulate", scene, "-o", other, "--resume", "-q"]):
            outcome = subprocess.run([program, *words], capture_output=True, text=True)
            assert outcome.returncode == 1 and outcome.stderr.count("\n") == 1, outcome
            assert other.read_bytes() == before
        return outcome.stderr

    def later(other):
        with h5py.File(other, "r+") as file:
            file.attrs["format"] = 4

    def foreign(other):
        with h5py.File(other, "w") as file:
            file["temperature"] = [1.0, 2.0]

    assert "has format 4; this program reads formats 1 to 3" in refusal(later, "later.h5")
    assert "not a Tanktread trajectory" in refusal(foreign, "foreign.h5")

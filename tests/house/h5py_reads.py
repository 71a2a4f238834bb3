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
        assert file.attrs["format"] == 1
        assert b"[time]" in file["scene"][()]
        position = file["position"][:count]
        order = int(file["order"][0, 0])
        rows = (order + 1) ** 2
        assert position.shape[1:3] == (1, 3) and position.shape[3] >= rows
        assert numpy.isfinite(position).all() and abs(position[0, 0, :, 1:4]).max() > 0.1
        assert list(file["steps/step"][: int(file["steps/count"][()])]) == [1, 2, 3]
        assert all(file[name].attrs["meaning"] for name in file if name != "steps")
        # The checksum of the first step record: row number, then its numbers in the order of the file.
        names = sorted((n for n in file["steps"] if n not in ("count", "checksum")), key=lambda n: file["steps"][n].id.get_offset())
        row = numpy.uint64(0).tobytes() + b"".join(file["steps"][n][0].tobytes() for n in names)
        assert int(file["steps/checksum"][0]) == (1 << 32) + zlib.crc32(row)

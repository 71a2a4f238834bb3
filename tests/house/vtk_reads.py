#!/usr/bin/env python3
"""What `export --vtk` and `--ply` write is what VTK reads: vtk_reads.py PROGRAM SCENE. Skipped where VTK is missing."""

import csv
import math
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    print("skipped: VTK for Python is missing (Debian: apt-get install python3-vtk9)")
    sys.exit(77)

program, scene = sys.argv[1:]


def check_mesh(mesh, area, volume, vesicles):
    """Closed, outward, and of the area and volume of the table (to the second order of the mesh)."""
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(mesh)
    edges.BoundaryEdgesOn()
    edges.NonManifoldEdgesOn()
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    assert edges.GetOutput().GetNumberOfCells() == 0, "the mesh is not closed"
    size = vtk.vtkMassProperties()
    size.SetInputData(mesh)
    assert math.isclose(size.GetSurfaceArea(), area, rel_tol=3e-3), (size.GetSurfaceArea(), area)
    assert math.isclose(size.GetVolume(), volume, rel_tol=3e-3), (size.GetVolume(), volume)
    # The flux of the position through the triangles is 3 V when they are oriented outward.
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (points[corners[:, k]] for k in range(3))
    import numpy
    flux = numpy.einsum("ij,ij->i", a, numpy.cross(b, c)).sum() / 6
    assert math.isclose(flux, volume, rel_tol=3e-3), "triangles are not oriented outward"


with tempfile.TemporaryDirectory() as folder:
    folder = Path(folder)
    path = folder / "t.h5"
    subprocess.run([program, "simulate", scene, "-o", path, "--steps", "4", "--quiet"], check=True)
    subprocess.run([program, "export", path, "--csv", folder / "t.csv", "--vtk", folder / "vtk", "--ply", folder / "ply", "-q"], check=True)
    rows = list(csv.DictReader(open(folder / "t.csv")))
    vesicles = 1 + max(int(row["vesicle"]) for row in rows)
    times = [float(row["time"]) for row in rows if row["vesicle"] == "0"]

    series = [(float(d.get("timestep")), d.get("file")) for d in xml.parse(folder / "vtk/series.pvd").iter("DataSet")]
    assert [t for t, _ in series] == times, (series, times)
    for k, (time, name) in enumerate(series):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / "vtk" / name))
        reader.Update()
        assert reader.GetErrorCode() == 0
        mesh = reader.GetOutput()
        data = mesh.GetPointData()
        names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
        assert names == ["normal", "velocity", "tension", "mean_curvature", "label", "vesicle"], names
        assert [data.GetArray(n).GetNumberOfComponents() for n in names] == [3, 3, 1, 1, 3, 1]
        assert mesh.GetNumberOfPoints() == vesicles * (63 * 128 + 2), mesh.GetNumberOfPoints()
        assert mesh.GetFieldData().GetArray("TimeValue").GetValue(0) == time
        here = [row for row in rows if float(row["time"]) == time]
        check_mesh(mesh, sum(float(r["area"]) for r in here), sum(float(r["volume"]) for r in here), vesicles)
        values = {n: vtk_to_numpy(data.GetArray(n)) for n in names}
        assert abs((values["normal"] ** 2).sum(axis=1) - 1).max() < 1e-5
        assert abs((values["label"] ** 2).sum(axis=1) - 1).max() < 1e-5
        if k == 0:  # the label is the parameter: the last two points are the poles
            assert abs(values["label"][-1] - (0, 0, -1)).max() < 1e-5, values["label"][-1]
        lowest, highest = min(float(r["tension_min"]) for r in here), max(float(r["tension_max"]) for r in here)
        room = 0.02 * (highest - lowest) + 1e-6  # the table's extremes are those of another grid
        assert lowest - room < values["tension"].min() and values["tension"].max() < highest + room
        # The integral of |u|^2 by the mesh's own areas.
        assert (values["mean_curvature"] < 0).mean() > 0.5  # -1/R on a sphere

        for v in range(vesicles):
            reader = vtk.vtkPLYReader()
            reader.SetFileName(str(folder / f"ply/vesicle-{v}-{k:06}.ply"))
            reader.Update()
            row = here[v]
            check_mesh(reader.GetOutput(), float(row["area"]), float(row["volume"]), 1)
            header = (folder / f"ply/vesicle-{v}-{k:06}.ply").read_bytes().split(b"end_header\n")[0].decode()
            assert [line.split()[-1] for line in header.splitlines() if line.startswith("property float")] == (
                "x y z nx ny nz velocity_x velocity_y velocity_z tension mean_curvature label_x label_y label_z vesicle".split())
    print(f"VTK {vtk.vtkVersion().GetVTKVersion()} reads {len(series)} states")

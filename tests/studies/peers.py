#!/usr/bin/env python3
"""One crowd drawn by this program, by VTK and by Blender: peers.py PROGRAM TRAJECTORY --time T -o SHEET.png.

The same meshes (`export --vtk`, `export --ply`), the same camera (that of the page of `export --html`, which knows it in
numbers), the same size. VTK is tuned as its users tune it: physically based shading, ambient occlusion in screen space,
silhouettes, eight samples a pixel. Blender paints with Cycles. Prints the processor
time (user and system) of each process as a row of a table, start-up and reading of files included, and writes the pictures
on one sheet. What is not installed is left out, and said so. Needs Pillow; VTK by python3-vtk9 and xvfb, Blender by blender.
"""

import argparse
import json
import math
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

COLOURS = ["#d66d4f", "#b6c5f6", "#55b791", "#efc962", "#6d5c4f", "#b687aa", "#7f64b8", "#ddd7d9"]  # tanktread list colours

VTK_SCRIPT = r"""
import json, sys
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
import numpy
job = json.load(open(sys.argv[1]))
reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName(job["vtp"])
reader.Update()
whole = reader.GetOutput()
ids = vtk_to_numpy(whole.GetPointData().GetArray("vesicle")).astype(int)
table = numpy.array([[int(c[k:k + 2], 16) for k in (1, 3, 5)] for c in job["colours"]], dtype=numpy.uint8)
colours = numpy_to_vtk(table[ids % len(table)], deep=True)
colours.SetName("colour")
whole.GetPointData().SetScalars(colours)
normals = whole.GetPointData().GetArray("normal")
if normals:
    whole.GetPointData().SetNormals(normals)
mapper = vtk.vtkPolyDataMapper()
mapper.SetInputData(whole)
actor = vtk.vtkActor()
actor.SetMapper(mapper)
look = actor.GetProperty()
look.SetInterpolationToPBR()
look.SetMetallic(0.0)
look.SetRoughness(0.35)
renderer = vtk.vtkRenderer()
renderer.SetBackground(1, 1, 1)
renderer.AddActor(actor)
camera = renderer.GetActiveCamera()
camera.SetPosition(job["eye"])
camera.SetFocalPoint(job["target"])
camera.SetViewUp(job["up"])
camera.SetViewAngle(job["angle"])
edges = vtk.vtkPolyDataSilhouette()
edges.SetInputData(whole)
edges.SetCamera(camera)
edges.SetEnableFeatureAngle(0)
lines = vtk.vtkPolyDataMapper()
lines.SetInputConnection(edges.GetOutputPort())
lines.ScalarVisibilityOff()
contour = vtk.vtkActor()
contour.SetMapper(lines)
contour.GetProperty().SetColor(0.1, 0.11, 0.14)
contour.GetProperty().SetLineWidth(2)
contour.GetProperty().LightingOff()
renderer.AddActor(contour)
for position, intensity in ((-0.45, 0.75, 0.85), 2.2), ((0.7, -0.25, 0.65), 0.7), ((0.0, 1.0, 0.2), 0.9):
    light = vtk.vtkLight()
    light.SetLightTypeToCameraLight()
    light.SetPosition(position)
    light.SetIntensity(intensity)
    renderer.AddLight(light)
passes = vtk.vtkRenderStepsPass()
ssao = vtk.vtkSSAOPass()
ssao.SetRadius(1.2)
ssao.SetBias(0.02)
ssao.SetKernelSize(128)
ssao.BlurOn()
ssao.SetDelegatePass(passes)
smooth = vtk.vtkSSAAPass()
smooth.SetDelegatePass(ssao)
renderer.SetPass(smooth)
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(job["size"])
window.AddRenderer(renderer)
renderer.ResetCameraClippingRange()
window.Render()
grab = vtk.vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtk.vtkPNGWriter()
writer.SetFileName(job["out"])
writer.SetInputConnection(grab.GetOutputPort())
writer.Write()
"""

BLENDER_SCRIPT = r"""
import json, sys
import bpy, mathutils
job = json.load(open(sys.argv[sys.argv.index("--") + 1]))
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
linear = lambda s: s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4
for k, path in enumerate(job["plys"]):
    bpy.ops.import_mesh.ply(filepath=path)
    body = bpy.context.selected_objects[0]
    for face in body.data.polygons:
        face.use_smooth = True
    c = job["colours"][k % len(job["colours"])]
    paint = bpy.data.materials.new(str(k))
    paint.use_nodes = True
    shader = paint.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = [linear(int(c[i:i + 2], 16) / 255) for i in (1, 3, 5)] + [1]
    shader.inputs["Roughness"].default_value = 0.35
    body.data.materials.clear()
    body.data.materials.append(paint)
world = bpy.data.worlds.new("white")
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (1, 1, 1, 1)
world.node_tree.nodes["Background"].inputs[1].default_value = 0.75
scene.world = world
back, up, right = (mathutils.Vector(job[k]) for k in ("back", "up", "right"))
turn = mathutils.Matrix((right, up, back)).transposed()
sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
sun.data.energy = 1.6
sun.data.angle = 0.2
sun.rotation_mode = "QUATERNION"
sun.rotation_quaternion = (turn @ mathutils.Vector((-0.45, 0.75, 0.85))).to_track_quat("Z", "Y")
scene.collection.objects.link(sun)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.sensor_fit = "VERTICAL"
camera.data.angle = job["angle"] * 3.141592653589793 / 180
camera.matrix_world = mathutils.Matrix.Translation(job["eye"]) @ turn.to_4x4()
camera.data.clip_end = 1e4
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = job["samples"]
scene.cycles.use_denoising = False  # Debian builds it without
scene.cycles.max_bounces = 4
scene.render.film_transparent = True
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = job["size"]
scene.render.resolution_percentage = 100
scene.render.filepath = job["out"]
bpy.ops.render.render(write_still=True)
"""


def timed(words, **more):
    """Status and processor seconds of a process and of all its children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, capture_output=True, text=True, errors="replace", **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print("\n".join((done.stdout + done.stderr).splitlines()[-8:]), file=sys.stderr)
    return done.returncode, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def picture_in(path):
    """On white, where it is transparent."""
    picture = Image.open(path).convert("RGBA")
    return Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture).convert("RGB")


def camera_of(program, trajectory, view, folder):
    """Of the page: lengths in area radii, and the area radius is 1 in these scenes."""
    page = folder / "page.html"
    subprocess.run([program, "export", trajectory, "--html", page, "-q", *view], check=True)
    text = page.read_text()
    data = json.loads(re.search(r'"camera":(\{.*?\}),"views"', text).group(1))
    return data


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("trajectory")
    parser.add_argument("--time", default="1")
    parser.add_argument("--target", default="0,0,0", help="the point in the middle")
    parser.add_argument("--size", default="960x540")
    parser.add_argument("--samples", type=int, default=48, help="of Cycles, a pixel")
    parser.add_argument("--zoom", default="1")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--work", help="keep what is made here")
    args = parser.parse_args()
    folder = Path(args.work or tempfile.mkdtemp()).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    size = [int(n) for n in args.size.split("x")]
    target = [float(x) for x in args.target.split(",")]
    view = ["--set", "view.camera=three-quarter", "--set", f"view.target={target}", "--set", "view.follow=never",
            "--set", f"view.zoom={args.zoom}"]
    bare = [word for key in ("flow_arrows", "time_stamp", "caption", "scale_bar") for word in ("--set", f"view.{key}=false")]
    camera = camera_of(args.program, args.trajectory, view + ["--set", f"view.size={size}"], folder)
    axes = camera["axes"]
    eye = [t + camera["distance"] * b for t, b in zip(target, axes["back"])]
    job = {"size": size, "colours": COLOURS, "target": target, "eye": eye, **axes,
           "angle": 2 * math.degrees(math.atan(camera["half_height"] / camera["distance"])), "samples": args.samples}
    panels = []

    def draw(name, words, out, cpu=0.0):
        status, seconds = timed(words)
        if status or not out.exists():
            print(f"| {name} | failed |")
            return
        panels.append((name, cpu + seconds, picture_in(out)))
        print(f"| {name} | {cpu + seconds:.1f} |", flush=True)

    for name, more in (("tanktread, as it comes", []), ("tanktread, plain", ["--style", "plain", "--set", "view.tracers=false"])):
        out = folder / (name.split()[-1] + ".png")
        draw(name, [args.program, "render", args.trajectory, "--time", args.time, "-o", out, "--force", "--size", args.size,
                    "--set", "view.background=white", *view, *(more + bare if more else []), "-q"], out)

    vtk_python = next((p for p in ("/usr/bin/python3", sys.executable)
                       if subprocess.run([p, "-c", "import vtk"], capture_output=True).returncode == 0), None)
    screen = ["xvfb-run", "-a"] if shutil.which("xvfb-run") else []  # Debian's VTK draws by X
    if vtk_python:
        status, seconds = timed([args.program, "export", args.trajectory, "--time", args.time, "--vtk", folder / "vtk", "-q"])
        (folder / "by_vtk.py").write_text(VTK_SCRIPT)
        own = {**job, "vtp": str(next((folder / "vtk").glob("*.vtp"))), "out": str(folder / "vtk.png")}
        (folder / "vtk.json").write_text(json.dumps(own))
        draw("VTK: PBR, SSAO, silhouettes", [*screen, vtk_python, folder / "by_vtk.py", folder / "vtk.json"], folder / "vtk.png", seconds)
    else:
        print("| VTK | not installed: python3-vtk9, xvfb |")

    if shutil.which("blender"):
        status, seconds = timed([args.program, "export", args.trajectory, "--time", args.time, "--ply", folder / "ply", "-q"])
        plys = sorted((folder / "ply").glob("*.ply"), key=lambda p: int(p.name.split("-")[1]))
        (folder / "by_blender.py").write_text(BLENDER_SCRIPT)
        own = {**job, "plys": [str(p) for p in plys], "out": str(folder / "cycles.png")}
        (folder / "blender.json").write_text(json.dumps(own))
        draw(f"Blender Cycles, {args.samples} samples",
             ["blender", "-b", "--python", folder / "by_blender.py", "--", folder / "blender.json"], folder / "cycles.png",
             seconds)
    else:
        print("| Blender | not installed |")

    font = ImageFont.truetype("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", 20)
    rows = (len(panels) + 1) // 2
    sheet = Image.new("RGB", (2 * size[0] + 12, rows * (size[1] + 44)), "white")
    pen = ImageDraw.Draw(sheet)
    for k, (name, seconds, picture) in enumerate(panels):
        x, y = k % 2 * (size[0] + 12), k // 2 * (size[1] + 44)
        sheet.paste(picture, (x, y + 36))
        pen.text((x + 12, y + 6), f"{name}: {seconds:.1f} s", fill="black", font=font)
    sheet.resize((sheet.width * 2 // 3, sheet.height * 2 // 3), Image.LANCZOS).save(args.output, optimize=True)


if __name__ == "__main__":
    main()

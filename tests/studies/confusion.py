#!/usr/bin/env python3
"""Which changes of a picture the presets of `compare` notice, beside pixelmatch and odiff: the table of docs/ci.md.

    tests/studies/confusion.py BUILD [NODE_FOLDER]

BUILD holds tanktread and tests/render/test_render. NODE_FOLDER is where `npm install pixelmatch pngjs odiff-bin` was run;
without it the two have no columns. The table goes to standard output; nothing but a temporary folder is written.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SIZES = ("1920x1080", "640x360")
BENIGN = {
    "drawn once more": {},
    "`LP_NUM_THREADS=0`": {"LP_NUM_THREADS": "0"},
    "`LP_NUM_THREADS=1`": {"LP_NUM_THREADS": "1"},
    "`LP_NUM_THREADS=16`": {"LP_NUM_THREADS": "16"},
    "`LP_NATIVE_VECTOR_WIDTH=128`": {"LP_NATIVE_VECTOR_WIDTH": "128"},
    "`LP_NATIVE_VECTOR_WIDTH=512`": {"LP_NATIVE_VECTOR_WIDTH": "512"},
    "`--gl osmesa`": {"TANKTREAD_GL": "osmesa"},
    "`--gl egl`": {"TANKTREAD_GL": "egl"},
    "`MESA_SHADER_CACHE_DISABLE=true`": {"MESA_SHADER_CACHE_DISABLE": "true"},
    "`GALLIUM_OVERRIDE_CPU_CAPS=avx`": {"GALLIUM_OVERRIDE_CPU_CAPS": "avx"},
    "`GALLIUM_OVERRIDE_CPU_CAPS=sse4.1`": {"GALLIUM_OVERRIDE_CPU_CAPS": "sse4.1"},
    "`GALLIUM_OVERRIDE_CPU_CAPS=nosse`": {"GALLIUM_OVERRIDE_CPU_CAPS": "nosse"},
}
OTHERS = """
import fs from "node:fs";
import {createRequire} from "node:module";
import {pathToFileURL} from "node:url";
const require = createRequire(process.argv[1] + "/");
const load = async name => { try { return require(name); } catch { return import(pathToFileURL(require.resolve(name))); } };
const {PNG} = await load("pngjs"), odiff = await load("odiff-bin"), match = await load("pixelmatch");
const pixelmatch = match.default ?? match;
const read = name => PNG.sync.read(fs.readFileSync(name));
const answers = [];
for (const [a, b] of JSON.parse(fs.readFileSync(0))) {
  const p = read(a), q = read(b);
  answers.push([pixelmatch(p.data, q.data, null, p.width, p.height) > 0, !(await odiff.compare(a, b, process.argv[2])).match]);
}
console.log(JSON.stringify(answers));
"""


def draw(build, folder, test, extra):
    environment = dict(os.environ, TANKTREAD_PICTURES=str(folder), **extra)
    # Whether every defect is caught is for the table to say.
    subprocess.run([build / "tests/render/test_render", test], env=environment, stdout=subprocess.DEVNULL, check=False)


def measures(build, pairs, preset):
    answers = []
    for a, b in pairs:
        out = subprocess.run([build / "tanktread", "compare", "--json", "--preset", preset, a, b], capture_output=True, text=True).stdout
        answers.append(json.loads(out)["pictures"][0])
    return answers


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    node = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(os.environ.get("TANKTREAD_KEEP", name))
        if not (folder / "defects").exists():
            draw(build, folder / "defects", "[defects]", {})
        for row, (label, extra) in enumerate(BENIGN.items()):
            if not (folder / f"benign{row}").exists():
                draw(build, folder / f"benign{row}", "[good]", extra)
        rows = []  # kind, label, size, pair
        for size in SIZES:
            good = folder / "defects" / size / "good.png"
            for path in sorted((folder / "defects" / size).iterdir(), key=lambda p: p.stat().st_mtime_ns):
                if path != good:
                    rows.append(("defect", path.stem, size, (good, path)))
            for row, label in enumerate(BENIGN):
                rows.append(("benign", label, size, (good, folder / f"benign{row}" / size / "good.png")))
        pairs = [row[3] for row in rows]
        columns = {"default": measures(build, pairs, "default"), "perceptual": measures(build, pairs, "perceptual")}
        flagged = {preset: [answer["verdict"] != "same" for answer in answers] for preset, answers in columns.items()}
        if node:
            text = json.dumps([[str(a), str(b)] for a, b in pairs])
            out = subprocess.run(["node", "--input-type=module", "-e", OTHERS, str(node), str(folder / "difference.png")], cwd=node, input=text,
                                 capture_output=True, text=True, check=True).stdout
            answers = json.loads(out)
            flagged["pixelmatch"] = [a for a, _ in answers]
            flagged["odiff"] = [b for _, b in answers]
        tools = list(flagged)
        both = " / ".join(size.replace("x", " × ") for size in SIZES)
        print(f"At {both}:\n")
        print("| change | largest | above 2 | rmse | FLIP mean | FLIP max | " + " | ".join(tools) + " |")
        print("|---" * (6 + len(tools)) + "|")
        places = {}
        for k, (kind, label, size, _) in enumerate(rows):
            places.setdefault((kind, label), {})[size] = k
        for (kind, label), of in places.items():
            ks = [of[size] for size in SIZES]
            numbers = lambda preset, key, form: " / ".join(form.format(columns[preset][k][key]) for k in ks)
            words = []
            for tool in tools:
                seen = [flagged[tool][k] for k in ks]
                if kind == "benign":
                    words.append("**false alarm**" if any(seen) else "same")
                elif all(seen):
                    words.append("caught")
                else:
                    words.append("**missed**" if not any(seen) else f"**{SIZES[seen.index(True)].replace('x', ' × ')} only**")
            print(f"| {label} | {numbers('default', 'maximum', '{:.3g}')} | {numbers('default', 'above', '{}')} | "
                  f"{numbers('default', 'rmse', '{:.2g}')} | {numbers('perceptual', 'flip_mean', '{:.1g}')} | "
                  f"{numbers('perceptual', 'flip_max', '{:.2f}')} | " + " | ".join(words) + " |")
        print()
        print("| of | " + " | ".join(tools) + " |")
        print("|---" * (1 + len(tools)) + "|")
        for kind, what in (("defect", "defects caught"), ("benign", "benign changes flagged")):
            for size in SIZES:
                chosen = [k for k, row in enumerate(rows) if row[0] == kind and row[2] == size]
                counts = [sum(flagged[t][k] for k in chosen) for t in tools]
                print(f"| {len(chosen)} {what}, {size.replace('x', ' × ')} | " + " | ".join(map(str, counts)) + " |")


main()

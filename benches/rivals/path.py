#!/usr/bin/env python3
"""The library's path tracing beside Mitsuba 3: the same scenes, cameras and estimator.

    RAYDSL_DATA=FOLDER python3 benches/rivals/path.py [--rounds 5] [--json FILE]

FOLDER holds `sponza.tri` and `cameras.json`; without it there is the Cornell box alone. Python needs
`numpy` and `mitsuba`; without them everything is skipped.

    pip install numpy mitsuba==3.9.1

The variant `llvm_ad_rgb` compiles what it renders and needs LLVM's library, a recent one: version 19
will do, 14 and 15 give up on AVX-512 (Debian: `apt-get install libllvm19`; DRJIT_LIBLLVM_PATH names the
file where there are several). `scalar_rgb` needs nothing.

All render on one thread: CPU time of all threads of the process is counted, after a picture that
warms up (where LLVM compiles; no compiling is counted). Of the library it is the thread's. Building
trees is not counted. Mitsuba's integrator is `path` with its defaults but for two: `max_depth` counts
the light's way to the first surface, so it is one more than the bounces here, and `rr_depth` is above
it, as the library's paths here end by no roulette either. Its film has the box filter, its sampler is
`independent`, its surfaces `twosided` and `diffuse`; the lamp is one mesh, whose points it samples by
area, where the library samples the triangles' solid angle.

All take turns, round by round. A rate is millions of samples of pixels a second. The error is relMSE,
the mean over all pixels and channels of `(x - r)^2 / (r^2 + 0.01)`, against a reference of the
library with other random numbers; `x s` is that times the seconds, `mean` the picture's mean over the
reference's, less 1. The two ratios, the medians of each round's, are to plain scalar Rust.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OURS = ["plain Rust", "scalar sobol", "packet8 sobol", "packet16"]


def skip(name, why, how):
    print(f"SKIPPED {name}: {why}\n        {how}", file=sys.stderr)


def bench(options):
    command = ["cargo", "bench", "-q", "-p", "raydsl-benches", "--bench", "path", "--", *options]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


class Ours:
    """The library, and plain Rust."""

    name = "raydsl"

    def __init__(self, cases, folder, samples):
        self.cases, self.folder, self.samples = cases, folder, samples

    def round(self, seed):
        """Gives scene, renderer, rate, error and the mean's difference of each picture."""
        rows = self.folder / "rows.json"
        options = ["--json", str(rows), "--rounds", "1", "--seed", str(seed)]
        options += ["--references", str(self.folder), "--samples", str(self.samples)]
        options += ["--size", str(self.cases[0]["size"])]
        options += ["--bounces", str(self.cases[0]["bounces"])]
        if len(self.cases) == 1:
            options += ["--scene", self.cases[0]["name"]]
        for name in OURS:
            options += ["--only", name]
        bench(options)
        for row in json.loads(rows.read_text()):
            name = row["renderer"]
            name = name if name.startswith("plain") else f"raydsl {name}"
            yield row["scene"], name, row["rate"], row["rel_mse"], row["bias"]


class Mitsuba:
    """One variant of Mitsuba 3."""

    def __init__(self, variant, cases, folder, samples):
        import drjit
        import mitsuba as mi

        self.mi, self.variant, self.cases, self.samples = mi, variant, cases, samples
        self.name = f"mitsuba {variant}"
        mi.set_variant(variant)
        drjit.set_thread_count(1)
        self.scenes = [mi.load_dict(scene_of(mi, case, folder)) for case in cases]
        self.references = [
            np.fromfile(folder / case["reference"], "<f4").reshape(case["size"], case["size"], 3)
            for case in cases
        ]
        for i in range(len(cases)):
            self.render(i, 0)

    def render(self, i, seed):
        return np.array(self.mi.render(self.scenes[i], spp=self.samples, seed=seed))

    def round(self, seed):
        self.mi.set_variant(self.variant)
        for i, case in enumerate(self.cases):
            start = time.process_time()
            picture = self.render(i, seed + 1)
            seconds = time.process_time() - start
            # The reference's lowest row is the first one.
            picture = picture[::-1, :, :3].astype(np.float64)
            reference = self.references[i].astype(np.float64)
            error = ((picture - reference) ** 2 / (reference**2 + 0.01)).mean()
            rate = case["size"] ** 2 * self.samples / seconds * 1e-6
            bias = picture.mean() / reference.mean() - 1
            yield case["name"], self.name, rate, float(error), float(bias)


def scene_of(mi, case, folder):
    """Makes the dictionary of a scene: one mesh for each colour and radiance."""
    facets = np.fromfile(folder / case["facets"], "<f4").reshape(-1, 15)
    film = {
        "type": "hdrfilm",
        "width": case["size"],
        "height": case["size"],
        "pixel_format": "rgb",
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }
    view = {"origin": case["eye"], "target": case["center"], "up": case["up"]}
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": case["bounces"] + 1, "rr_depth": 1000},
        "sensor": {
            "type": "perspective",
            "fov": float(np.degrees(case["fov_y"])),
            "fov_axis": "y",
            "near_clip": 1e-3,
            "far_clip": 1e5,
            "to_world": mi.ScalarTransform4f().look_at(**view),
            "film": film,
            "sampler": {"type": "independent"},
        },
    }
    if any(case["sky"]):
        scene["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": case["sky"]}}
    for i, look in enumerate(np.unique(facets[:, 9:], axis=0)):
        file = folder / f"{case['name']}.{i}.ply"
        write_ply(file, facets[(facets[:, 9:] == look).all(1), :9].reshape(-1, 3))
        color, radiance = look[:3].tolist(), look[3:].tolist()
        diffuse = {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}}
        mesh = {"type": "ply", "filename": str(file), "face_normals": True}
        mesh["bsdf"] = {"type": "twosided", "side": diffuse}
        if any(radiance):
            mesh["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": radiance}}
        scene[f"mesh{i}"] = mesh
    return scene


def write_ply(path, corners):
    """Writes triangles of three corners each."""
    faces = np.zeros(len(corners) // 3, [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = np.arange(len(corners)).reshape(-1, 3)
    header = f"""ply
format binary_little_endian 1.0
element vertex {len(corners)}
property float x
property float y
property float z
element face {len(faces)}
property list uchar int vertex_indices
end_header
"""
    path.write_bytes(header.encode() + corners.astype("<f4").tobytes() + faces.tobytes())


def probe(variant):
    """Renders something elsewhere: a library that does not fit ends the whole process."""
    program = f"""
import mitsuba as mi
mi.set_variant("{variant}")
import numpy
numpy.array(mi.render(mi.load_dict(mi.cornell_box()), spp=1))
"""
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError((done.stderr.strip().splitlines() or ["no message"])[0])


def contenders(cases, folder, samples):
    yield Ours(cases, folder, samples)
    for variant in ["llvm_ad_rgb", "scalar_rgb"]:
        try:
            probe(variant)
            yield Mitsuba(variant, cases, folder, samples)
        except Exception as why:  # Whatever is missing there: the others are still measured.
            skip(f"mitsuba {variant}", why, "pip install mitsuba==3.9.1; LLVM: libllvm19")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", choices=["cornell", "sponza"], help="only this one")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, default=512, help="width and height of the pictures")
    parser.add_argument("--samples", type=int, default=64, help="of each pixel")
    parser.add_argument("--reference", type=int, default=8192, help="samples of the references")
    parser.add_argument("--scenes", type=Path, help="keeps scenes and references in this folder")
    parser.add_argument("--json", type=Path, help="writes the rows to this file")
    args = parser.parse_args()
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = args.scenes or Path(folder)
        is_there = Path(os.environ.get("RAYDSL_DATA", ""), "sponza.tri").exists()
        names = ["cornell", "sponza"] if is_there else ["cornell"]
        if not is_there:
            skip("sponza", "no sponza.tri", "RAYDSL_DATA names the folder with it and cameras.json")
        names = [args.scene] if args.scene else names
        if not all((folder / f"{name}.json").exists() for name in names):
            options = ["--write-scenes", str(folder), "--size", str(args.size)]
            options += ["--scene", args.scene] if args.scene else []
            bench([*options, "--reference", str(args.reference)])
        cases = [json.loads((folder / f"{name}.json").read_text()) for name in names]
        size = cases[0]["size"]
        print(f"{size} x {size} pixels, {args.samples} samples each, one thread")
        sides = list(contenders(cases, folder, args.samples))
        for seed in range(args.rounds):
            for side in list(sides):
                try:
                    for scene, name, rate, error, bias in side.round(seed):
                        seconds = size**2 * args.samples / rate * 1e-6
                        rows.setdefault((scene, name), []).append(
                            {"rate": rate, "error": error, "cost": error * seconds, "bias": bias}
                        )
                except Exception as why:
                    skip(side.name, why, "it failed while it rendered")
                    sides.remove(side)
    table(rows, args.json)


def table(rows, path):
    print(f"{'':<9}{'renderer':<26}{'M/s':>8}{'from':>8}{'to':>8}{'ratio':>7}", end="")
    print(f"{'relMSE':>10}{'x s':>10}{'ratio':>7}{'mean':>8}")
    out = []
    for (scene, name), rounds in sorted(rows.items(), key=lambda row: row[0][0]):
        plain = rows.get((scene, "plain Rust"), [])
        column = {key: [r[key] for r in rounds] for key in rounds[0]}
        middle = {key: statistics.median(values) for key, values in column.items()}
        # Each round's own ratio: a machine that slows down slows down all.
        ratios = {
            key: statistics.median(a[key] / b[key] for a, b in zip(rounds, plain)) if plain else 0
            for key in ["rate", "cost"]
        }
        low, high = min(column["rate"]), max(column["rate"])
        print(f"{scene:<9}{name:<26}{middle['rate']:>8.3f}{low:>8.3f}{high:>8.3f}", end="")
        print(f"{ratios['rate']:>7.2f}{middle['error']:>10.2e}{middle['cost']:>10.2e}", end="")
        print(f"{ratios['cost']:>7.3f}{100 * middle['bias']:>7.2f}%")
        row = {"scene": scene, "renderer": name, "from": low, "to": high}
        out.append(row | middle | {"rate_to_plain": ratios["rate"], "cost_to_plain": ratios["cost"]})
    if path:
        path.write_text(json.dumps(out, indent=2))


if __name__ == "__main__":
    try:
        import mitsuba
        import numpy as np
    except ImportError as why:
        skip("all rivals", why, "pip install numpy mitsuba==3.9.1")
        sys.exit(0)
    main()

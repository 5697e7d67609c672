#!/usr/bin/env python3
"""The library's volumes beside other renderers: the same scan, camera and transfer functions.

    RAYDSL_DATA=FOLDER python3 benches/rivals/volumes.py [--rounds 5] [--json FILE]

FOLDER holds `mni152_t1_1mm.nii.gz`. Python needs `numpy`; and each rival a package of its own: a
rival without it is skipped.

    pip install numpy vtk==9.7.0 pynari

* `vtk`: the fixed-point ray caster (vtkFixedPointVolumeRayCastMapper) on one thread. Only its
  casting of rays is timed, not the setting up of its tables and not the display. It needs no
  screen, but some OpenGL to show its picture: EGL with Mesa will do (Debian: `apt-get install
  libegl1 libgl1`).
* `pynari`: the ANARI device of the package; without a GPU its path tracer on the CPU. Its rays make
  random steps, so there is no step to choose; and it scatters light, so its error is noise and the
  difference between the two models of light, and says little. A frame of one path a pixel is timed
  as a whole, in CPU time of all threads.

All take turns, round by round. A rate is that of nominal samples: the length of all rays in the
volume's box over the step, one voxel where there is no step. An error is a root mean square: of the
library's colours and opacities against `f64`, of the others' colours against the library's exact
picture. The last but one column is the median of each round's ratio to VTK at the same step.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STEPS = [1.0, 0.5, 0.25]


def skip(name, why, how):
    print(f"SKIPPED {name}: {why}\n        {how}", file=sys.stderr)


def bench(options):
    command = ["cargo", "bench", "-q", "-p", "raydsl-benches", "--bench", "volumes", "--", *options]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


class Ours:
    """A variant of the library."""

    def __init__(self, variant, case, folder):
        self.name, self.variant, self.rows = f"raydsl {variant}", variant, folder / "rows.json"
        self.pixels = case["pixels"]

    def round(self):
        """Gives function, integrator, rate and error of each row."""
        options = ["--json", str(self.rows), "--rounds", "1", "--variant", self.variant]
        options += ["--size", str(self.pixels), "--steps", ",".join(map(str, STEPS))]
        for name in ["exact cell", "midpoint", "naive"]:
            options += ["--only", name]
        bench(options)
        for row in json.loads(self.rows.read_text()):
            yield row["function"], row["integrator"], row["rate"], row["rms"]


class Vtk:
    """The fixed-point ray caster."""

    name = "vtk fixed point"

    def __init__(self, case, folder):
        import vtk
        from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

        self.vtk, self.to_numpy, self.case, self.folder = vtk, vtk_to_numpy, case, folder
        grid = vtk.vtkImageData()
        grid.SetDimensions(*case["size"])
        voxels = np.fromfile(folder / case["voxels"], np.uint8)
        grid.GetPointData().SetScalars(numpy_to_vtk(voxels, deep=1))
        self.mapper = mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.SetInputData(grid)
        mapper.SetNumberOfThreads(1)
        mapper.SetBlendModeToComposite()
        # One ray a pixel, and the step that is asked for.
        mapper.AutoAdjustSampleDistancesOff()
        mapper.LockSampleDistanceToInputSpacingOff()
        mapper.SetImageSampleDistance(1.0)
        mapper.IntermixIntersectingGeometryOff()
        self.look = look = vtk.vtkVolumeProperty()
        look.SetInterpolationTypeToLinear()
        look.ShadeOff()
        volume = vtk.vtkVolume()
        volume.SetMapper(mapper)
        volume.SetProperty(look)
        placement = vtk.vtkMatrix4x4()
        for row in range(3):
            for column in range(3):
                placement.SetElement(row, column, case["axes"][column][row])
            placement.SetElement(row, 3, case["origin"][row])
        volume.SetUserMatrix(placement)
        scene = vtk.vtkRenderer()
        scene.SetBackground(0, 0, 0)
        scene.AddVolume(volume)
        self.window = window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        # The picture in floats: rounding to bytes is not the ray caster's error.
        window.SetRenderBufferTargetDepthSize(32)
        window.SetSize(case["pixels"], case["pixels"])
        window.AddRenderer(scene)
        camera = scene.GetActiveCamera()
        eye = np.array(case["eye"])
        camera.SetPosition(*eye)
        camera.SetFocalPoint(*(eye + np.array(case["forward"])))
        camera.SetViewUp(*case["up"])
        camera.SetViewAngle(2 * np.degrees(np.arctan(case["extent"] / 2)))
        scene.ResetCameraClippingRange()

    def round(self):
        vtk, case = self.vtk, self.case
        size = case["pixels"]
        for function in case["functions"]:
            opacity, color = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
            for knot in function["opacities"]:
                opacity.AddPoint(*knot)
            for knot in function["colors"]:
                color.AddRGBPoint(*knot)
            self.look.SetScalarOpacity(opacity)
            self.look.SetColor(color)
            self.look.SetScalarOpacityUnitDistance(function["unit"])
            for step in STEPS:
                self.mapper.SetSampleDistance(step * case["voxel"])
                self.mapper.SetInteractiveSampleDistance(step * case["voxel"])
                # The tables are set up here, and the picture is shown.
                self.window.Render()
                start = time.thread_time()
                self.mapper.RenderSubVolume()
                seconds = time.thread_time() - start
                shown = vtk.vtkFloatArray()
                self.window.GetRGBAPixelData(0, 0, size - 1, size - 1, 0, shown)
                picture = self.to_numpy(shown).reshape(size, size, 4)
                rate = case["length"] / case["voxel"] / step / seconds * 1e-6
                yield function["name"], f"vtk {step}", rate, error(picture, function, self)


class Anari:
    """ANARI's default device, as the package has it."""

    def __init__(self, case, folder):
        import pynari as anari

        self.anari, self.case, self.folder = anari, case, folder
        kind = "GPU" if anari.has_cuda_capable_gpu() else "CPU"
        self.name = f"pynari default, {kind}"
        self.device = device = anari.newDevice("default")
        # The package takes the first axis for the fastest one, whatever the array's order.
        voxels = np.fromfile(folder / case["voxels"], np.uint8).reshape(case["size"])
        # Values from 0 to 1, the table's range unless it is set, for which the package has no type.
        voxels = np.ascontiguousarray(voxels, np.float32) / np.float32(255)
        data = device.newArray(anari.FLOAT32, voxels)
        field = device.newSpatialField("structuredRegular")
        field.setParameter("origin", anari.FLOAT32_VEC3, tuple(case["origin"]))
        spacing = tuple(case["axes"][i][i] for i in range(3))
        field.setParameter("spacing", anari.FLOAT32_VEC3, spacing)
        field.setParameter("data", anari.ARRAY, data)
        field.setParameter("filter", anari.STRING, "linear")
        field.commitParameters()
        self.field = field
        self.camera = camera = device.newCamera("perspective")
        camera.setParameter("position", anari.FLOAT32_VEC3, tuple(case["eye"]))
        camera.setParameter("direction", anari.FLOAT32_VEC3, tuple(case["forward"]))
        camera.setParameter("up", anari.FLOAT32_VEC3, tuple(case["up"]))
        camera.setParameter("aspect", anari.FLOAT32, 1.0)
        camera.setParameter("fovy", anari.FLOAT32, float(2 * np.arctan(case["extent"] / 2)))
        camera.commitParameters()

    def frame(self, function):
        anari, device, case = self.anari, self.device, self.case
        # ANARI's tables are even: a knot for each quarter of a value keeps those of the functions.
        values = np.linspace(0, 255, 255 * 4 + 1)
        colors = np.array(function["colors"])
        channels = [np.interp(values, colors[:, 0], colors[:, i]) for i in (1, 2, 3)]
        opacities = np.array(function["opacities"])
        channels.append(np.interp(values, opacities[:, 0], opacities[:, 1]))
        table = np.ascontiguousarray(np.stack(channels, 1), np.float32)
        volume = device.newVolume("transferFunction1D")
        volume.setParameter("color", anari.ARRAY, device.newArray(anari.FLOAT32_VEC4, table))
        volume.setParameter("unitDistance", anari.FLOAT32, float(function["unit"]))
        volume.setParameter("value", anari.SPATIAL_FIELD, self.field)
        volume.commitParameters()
        world = device.newWorld()
        world.setParameterArray("volume", anari.VOLUME, [volume])
        world.commitParameters()
        renderer = device.newRenderer("default")
        renderer.setParameter("pixelSamples", anari.INT32, 1)
        renderer.setParameter("ambientRadiance", anari.FLOAT32, 1.0)
        background = np.zeros((4, 1, 1), np.float32)
        background = device.newArray(anari.FLOAT32_VEC4, background)
        renderer.setParameter("background", anari.ARRAY, background)
        renderer.commitParameters()
        frame = device.newFrame()
        frame.setParameter("size", anari.uint2, (case["pixels"], case["pixels"]))
        frame.setParameter("channel.color", anari.DATA_TYPE, anari.FLOAT32_VEC4)
        frame.setParameter("renderer", anari.OBJECT, renderer)
        frame.setParameter("camera", anari.OBJECT, self.camera)
        frame.setParameter("world", anari.OBJECT, world)
        frame.commitParameters()
        return frame

    def round(self):
        size = self.case["pixels"]
        for function in self.case["functions"]:
            frame = self.frame(function)
            # The first frame sets things up.
            frame.render()
            start = time.process_time()
            frame.render()
            shown = frame.get("channel.color")
            seconds = time.process_time() - start
            picture = np.array(shown, np.float32).reshape(size, size, 4)
            rate = self.case["length"] / self.case["voxel"] / seconds * 1e-6
            yield function["name"], "anari", rate, error(picture, function, self)


def error(picture, function, of):
    """The root mean square difference of a colour from the exact picture."""
    exact = np.fromfile(of.folder / function["picture"], "<f4").reshape(picture.shape)
    difference = picture[..., :3].astype(np.float64) - exact[..., :3]
    return float(np.sqrt((difference**2).mean()))


def contenders(case, folder):
    for variant in ["scalar", "packet16"]:
        yield Ours(variant, case, folder)
    for rival, package, how in [
        (Vtk, "vtk", "pip install vtk==9.7.0; it needs EGL too: apt-get install libegl1 libgl1"),
        (Anari, "pynari", "pip install pynari"),
    ]:
        try:
            yield rival(case, folder)
        except Exception as why:  # Whatever is missing there: the others are still measured.
            skip(package, why, how)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", type=int, default=1024, help="width and height of the picture")
    parser.add_argument("--json", type=Path, help="writes the rows to this file")
    args = parser.parse_args()
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        bench(["--export", str(folder), "--size", str(args.size)])
        case = json.loads((folder / "case.json").read_text())
        print(f"{case['subject']}, {case['pixels']} x {case['pixels']}, one thread")
        sides = list(contenders(case, folder))
        for _ in range(args.rounds):
            for side in list(sides):
                try:
                    for function, integrator, rate, rms in side.round():
                        key = (function, side.name, integrator)
                        rows.setdefault(key, ([], []))
                        rows[key][0].append(rate)
                        rows[key][1].append(rms)
                except Exception as why:
                    skip(side.name, why, "it failed while it rendered")
                    sides.remove(side)
    table(rows, args.json)


def table(rows, path):
    print(f"{'':<6}{'renderer':<24}{'integrator':<18}{'M/s':>8}{'from':>8}{'to':>8}", end="")
    print(f"{'to VTK':>8}{'rms':>10}")
    out = []
    for key, (rates, errors) in sorted(rows.items(), key=lambda row: row[0][0]):
        function, name, integrator = key
        step = integrator.split()[-1]
        step = float(step) if step[0].isdigit() else 1.0
        vtk = rows.get((function, Vtk.name, f"vtk {step}"))
        # Each round's own ratio: a machine that slows down slows down both.
        ratio = statistics.median(a / b for a, b in zip(rates, vtk[0])) if vtk else None
        rate, rms = statistics.median(rates), statistics.median(errors)
        print(f"{function:<6}{name:<24}{integrator:<18}{rate:>8.1f}{min(rates):>8.1f}", end="")
        print(f"{max(rates):>8.1f}{f'{ratio:.2f}' if ratio else '-':>8}{rms:>10.1e}")
        row = {"function": function, "renderer": name, "integrator": integrator, "rate": rate}
        out.append(row | {"from": min(rates), "to": max(rates), "to_vtk": ratio, "rms": rms})
    if path:
        path.write_text(json.dumps(out, indent=2))


if __name__ == "__main__":
    try:
        import numpy as np
    except ImportError as why:
        skip("all rivals", why, "pip install numpy vtk==9.7.0 pynari")
        sys.exit(0)
    main()

# SPDX-License-Identifier: MIT
"""Measures the sample `volume` beside VTK's mappers for unstructured grids: the same grid, view and
transfer function, the error of each against the picture of the integrator, which draws in double
precision and has no code in common with either. Then what the tolerance of colors and the budget of
triangles buy.

Needs an X server for VTK, which is run on stock Mesa. Writes OUT.json, and pictures into a folder
of its name."""

import argparse
import datetime
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile

import numpy
from matplotlib.image import imsave

import output_file

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROJECT = os.path.join(ROOT, "build", "project")
RUN = os.path.join(ROOT, "scripts", "run")
VTK_VOLUME = os.path.join(ROOT, "scripts", "lib", "vtk_volume.py")

# Name, the model of scripts/fetch-data, options of the sample
SCENES = (
    ("bluntfin, haze", "bluntfin", ("--field", "Density", "--transfer", "haze",
                                    "--azimuth", "20", "--elevation", "30")),
    ("bluntfin, shells", "bluntfin", ("--field", "Density", "--transfer", "shells",
                                      "--azimuth", "20", "--elevation", "30")),
    ("combustor, haze", "combustor", ("--field", "Density", "--transfer", "haze",
                                      "--azimuth", "60", "--elevation", "25")),
)
# Name, form, options of the sample
OURS = tuple(("kbuffer-program", order, ("--k", k, "--order", order))
             for order in ("centroid", "nearest", "cells") for k in ("6", "12"))
OURS += tuple(("kbuffer-program", f"{order} tolerance 0.1",
               ("--k", k, "--order", order, "--tolerance", "0.1"))
              for order in ("centroid", "nearest") for k in ("6", "12"))
OURS += (("exact", "", ("--exact", "--k", "64")),
         ("exact", "tolerance 0.1", ("--exact", "--k", "64", "--tolerance", "0.1")))
VTK = ("vtk-projected-tetrahedra", "vtk-bunyk", "vtk-bunyk-partial", "vtk-zsweep")
# With k = 12, so that little else is wrong
TOLERANCES = (("--all-faces",), *(("--tolerance", value)
              for value in ("0", "0.01", "0.03", "0.1", "0.3", "1", "3")))
# k, order, budgets of triangles
ACCURACY = (("6", "centroid", ("1", "1.5", "2", "4", "8")),
            ("12", "centroid", ("1", "1.5", "2", "4", "8")),
            ("6", "nearest", ("1",)), ("12", "nearest", ("1",)),
            ("2", "cells", ("1",)), ("6", "cells", ("1",)))


def run(*command):
    """What the command prints. If it fails the study ends."""
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, text=True,
                          check=False)
    if done.returncode:
        sys.exit(f"this failed: {' '.join(str(part) for part in command)}")
    return done.stdout


def read_pfm(path):
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        pixels = numpy.frombuffer(file.read(), "<f4").reshape(height, width, 3)
    return pixels[::-1].astype(float)


def errors(picture, reference):
    difference = abs(picture - reference)
    return {"err_max": float(difference.max()),
            "err_rmse": float(numpy.sqrt((difference ** 2).mean())),
            "err_share": float((difference.max(axis=2) > 1 / 255).mean())}


def spread(values):
    low, middle, high = numpy.percentile(values, (5, 50, 95))
    return {"ms_median": float(middle), "ms_p5": float(low), "ms_p95": float(high),
            "frames": len(values)}


def describe(row):
    """Also the name of its picture."""
    k = str(row["k"]) if row["k"] else ""
    return " ".join(filter(None, (row["scene"] + ":", row["method"], row["form"], k)))


class Scene:
    """One grid, view and transfer function, and the picture that all are compared with."""

    def __init__(self, name, model, options, study):
        self.name, self.study = name, study
        self.options = ("--grid", os.path.join(ROOT, "build", "data", model + ".vtk"),
                        *options, "--size", study.size)
        self.reference = None
        self.document = None

    def path(self, name):
        return os.path.join(self.study.folder, name)

    def draw_reference(self):
        """What is drawn exactly is for the sample to say."""
        run(RUN, self.study.volume, *self.options, "--no-disorder",
            "--json", self.path("scene.json"))
        run(os.path.join(PROJECT, "tests", "integrator", "integrate"),
            "--scene", self.path("scene.json"), "--out", self.path("reference.pfm"))
        self.reference = read_pfm(self.path("reference.pfm"))
        with open(self.path("scene.json"), encoding="utf-8") as file:
            self.document = json.load(file)
        self.save(f"{self.name}: integrator", self.reference)

    def draw_ours(self, frames, *options):
        """The sample's own account of it, and the picture."""
        run(RUN, self.study.volume, *self.options, *options, "--repeat", frames + 1,
            "--json", self.path("ours.json"), "--float-out", self.path("ours.pfm"))
        with open(self.path("ours.json"), encoding="utf-8") as file:
            account = json.load(file)
        # The first frame also compiles.
        account["ms"] = account["ms"][1:]
        return account, read_pfm(self.path("ours.pfm"))

    def draw_vtk(self, frames, method):
        printed = run(RUN, "--stock", "/usr/bin/python3", "-B", VTK_VOLUME,
                      self.path("scene.json"), method, "--frames", frames,
                      "--out", self.path("vtk.pfm"))
        return json.loads(printed), read_pfm(self.path("vtk.pfm"))

    def save(self, name, picture):
        """The picture, and what is wrong with it, 20 times as strong."""
        for suffix, pixels in (("", picture), (" error", 20 * abs(picture - self.reference))):
            file = f"{name}{suffix}.png".replace(":", "")
            imsave(os.path.join(self.study.pictures, file), numpy.clip(pixels, 0, 1))


class Study:
    def __init__(self, options):
        self.size, self.rounds, self.frames = options.size, options.rounds, options.frames
        self.quick = options.quick
        self.volume = os.path.join(PROJECT, "samples", "volume", "volume")
        self.folder = tempfile.mkdtemp(dir=os.path.join(ROOT, "build"))
        self.pictures = os.path.join(self.folder, "pictures")
        os.mkdir(self.pictures)

    def compare(self, scene):
        """Rows of all methods, which take turns."""
        methods = [("ours", *method) for method in OURS]
        methods += [("stock", name, "", ()) for name in VTK
                    if not (self.quick and name == "vtk-zsweep")]
        rows = {}
        for turn in range(self.rounds):
            for driver, name, form, options in methods:
                row = rows.get((name, options))
                # What takes many seconds is not repeated.
                if turn and min(row["ms"]) > 5000:
                    continue
                if driver == "ours":
                    account, picture = scene.draw_ours(self.frames, "--no-disorder", *options)
                else:
                    account, picture = scene.draw_vtk(self.frames, name)
                if row is None:
                    k = account.get("k", 0)
                    row = rows[name, options] = {
                        "scene": scene.name, "method": name, "form": form, "driver": driver, "k": k,
                        "ms": [], "passes": account.get("passes", 1),
                        "triangles": account.get("triangles", 0),
                        "sort_ms": account.get("ms_parts", {}).get("sort"),
                        "what": account.get("what", ""), "runs_on": account.get("driver", ""),
                        **errors(picture, scene.reference)}
                    note(f"{describe(row)}: {numpy.median(account['ms']):.0f} ms")
                    scene.save(describe(row), picture)
                row["ms"] += account["ms"]
        for row in rows.values():
            row.update(spread(row.pop("ms")))
            note(f"{describe(row)}: {row['ms_median']:.0f} ms, "
                 f"error {row['err_rmse'] * 255:.3f}/255 (root mean square)")
        return list(rows.values())

    def tolerances(self, scene):
        """Rows of what cells that are joined save and what they cost."""
        rows = []
        for way in TOLERANCES[:3] if self.quick else TOLERANCES:
            account, picture = scene.draw_ours(self.frames, "--k", "12", "--no-disorder", *way)
            rows.append({"scene": scene.name, "tolerance": float(way[1]) if way[1:] else None,
                         "clusters": account["clusters"], "triangles": account["triangles"],
                         "triangles_drawn": account["triangles_drawn"],
                         "ms_clusters": account["ms_clusters"],
                         **errors(picture, scene.reference), **spread(account["ms"])})
            note(f"{scene.name}: {' '.join(way)}: {rows[-1]['triangles_drawn']} triangles drawn, "
                 f"{rows[-1]['ms_median']:.0f} ms")
        return rows

    def accuracy(self, scene):
        """Rows of what more triangles cost and what they bring."""
        rows = []
        for k, order, budgets in ACCURACY:
            for budget in budgets[:2] if self.quick else budgets:
                account, picture = scene.draw_ours(self.frames, "--k", k, "--order", order,
                                                   "--all-faces", "--budget", budget)
                disorder = account["disorder"]
                rows.append({"scene": scene.name, "k": int(k), "order": order,
                             "budget": float(budget), "triangles": account["triangles"],
                             "displacement": disorder["displacement"],
                             "share_wrong": disorder["share_wrong"],
                             "sort_ms": account["ms_parts"]["sort"],
                             **errors(picture, scene.reference), **spread(account["ms"])})
                note(f"{scene.name}: k = {k}, {order}, budget {budget}: displacement "
                     f"{disorder['displacement']}, {rows[-1]['ms_median']:.0f} ms")
        return rows


def note(text):
    print(f"    {text}", flush=True)


def machine(size, rounds):
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(": ", 1)[1].strip() for line in file if line.startswith("model name")]
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"],
                            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                            check=False)
    now = datetime.datetime.now(datetime.timezone.utc)
    return {"date": now.strftime("%Y-%m-%dT%H:%M:%SZ"), "commit": commit.stdout.strip(),
            "processor": names[0] if names else "unknown",
            "processors": len(os.sched_getaffinity(0)), "load_at_start": os.getloadavg()[0],
            "system": f"{platform.system()} {platform.release()} {platform.machine()}",
            "size": size, "rounds": rounds}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", metavar="OUT.json")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--rounds", type=int, default=5, help="turns of each method (5)")
    parser.add_argument("--frames", type=int, default=3, help="frames a turn (3)")
    parser.add_argument("--quick", action="store_true", help="one turn, one scene, no ZSweep")
    options = parser.parse_args()
    if options.quick:
        options.rounds, options.frames = 1, 2
    document = {"machine": machine(options.size, options.rounds), "results": [],
                "tolerances": [], "accuracy": []}
    study = Study(options)
    try:
        for name, model, arguments in SCENES[:1] if options.quick else SCENES:
            scene = Scene(name, model, arguments, study)
            scene.draw_reference()
            document.setdefault("scenes", {})[name] = {
                key: scene.document[key] for key in ("field", "camera", "transfer", "triangles")}
            document["results"] += study.compare(scene)
            document["tolerances"] += study.tolerances(scene)
            if "shells" not in name:
                document["accuracy"] += study.accuracy(scene)
        with output_file.written(options.out) as made, open(made, "w", encoding="utf-8") as file:
            json.dump(document, file, indent=1)
        target = os.path.splitext(options.out)[0]
        shutil.rmtree(target, ignore_errors=True)
        os.chmod(study.pictures, 0o755)
        shutil.move(study.pictures, target)
    finally:
        shutil.rmtree(study.folder, ignore_errors=True)


if __name__ == "__main__":
    main()

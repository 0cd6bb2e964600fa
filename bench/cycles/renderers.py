"""Runs Retrolux and Cycles on the same scenes, and reads and writes their pictures."""
import json
import os
import resource
import shutil
import subprocess
import time

import numpy as np
import OpenImageIO as oiio

HERE = os.path.dirname(os.path.abspath(__file__))

# The mask's materials. The rough ones have a lobe that is wide enough to be seen whole.
MATERIALS = {
    "diffuse": {"type": "diffuse", "reflectance": 0.5},
    "metal": {"type": "conductor", "reflectance": 0.5, "roughness": 0.3},
    "coated": {"type": "coated_diffuse", "reflectance": 0.5, "ior": 1.47, "roughness": 0.15},
}


def make_scenes(retrolux, out, size):
    """The built-in `oval` without markers and filter, once for each material; returns the folders.

    The diodes' light is within 1 nm, so that `radiance.Y` of a path does not depend on the
    wavelength that it drew. Without a filter it is the radiance of all light, as Cycles' is.
    """
    exported = os.path.join(out, "oval")
    retrolux.run("scene", "export", "oval", "--out", exported)
    with open(os.path.join(exported, "scene.json")) as file:
        scene = json.load(file)
    scene["markers"] = []
    scene["materials"] = {}
    scene["exposure"] = {"time_s": 0.006}
    camera = scene["cameras"][0]
    camera["filter"] = None
    camera["ring"]["fwhm_nm"] = 1.0
    resize(camera, size)
    folders = {}
    for name, material in MATERIALS.items():
        folders[name] = os.path.join(out, name)
        os.makedirs(folders[name], exist_ok=True)
        shutil.copy(os.path.join(exported, scene["objects"][0]["file"]), folders[name])
        scene["materials"]["mask"] = material
        with open(os.path.join(folders[name], "scene.json"), "w") as file:
            json.dump(scene, file, indent=2)
    return folders


def resize(camera, size):
    """Another number of pixels for the same field of view; the picture's edges stay."""
    k, old = camera["camera_matrix"], camera["size"]
    for axis, (focal, centre) in enumerate(((0, 2), (4, 5))):
        scale = size[axis] / old[axis]
        k[focal] *= scale
        k[centre] = (k[centre] + 0.5) * scale - 0.5
    camera["size"] = list(size)


# Each renderer's `render` makes pictures and returns each with its time {"wall_s", "cpu_s"}, of
# which CPU time is the user's, of all threads. A picture is given as {"spp", "seed"}; ours may have
# "edge_spp", that of pixels beside an edge, those of Cycles a "threshold": then `spp` is the most
# that a pixel gets, and it gets no more once Cycles thinks that its noise is below the threshold.


class Retrolux:
    name = "retrolux"

    def __init__(self, program, threads):
        self.program, self.threads = program, threads

    def run(self, *arguments):
        """The result of a command, and its time."""
        command = [self.program, "--json", "--progress", "none",
                   "--threads", str(self.threads), *map(str, arguments)]
        wall, cpu = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True)
        cpu = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - cpu
        return json.loads(done.stdout), {"wall_s": time.perf_counter() - wall, "cpu_s": cpu}

    def version(self):
        return output_of([self.program, "--version"]).strip()

    def render(self, scene, pictures):
        results = []
        out = os.path.join(scene, "retrolux")
        for picture in pictures:
            spp = picture["spp"]
            _, times = self.run("--seed", picture["seed"], "render",
                                os.path.join(scene, "scene.json"), "--spp", spp,
                                "--edge-spp", picture.get("edge_spp", spp), "--out", out)
            results.append((read_exr(os.path.join(out, "camera.exr"))["radiance.Y"], times))
        return results


class Cycles:
    name = "cycles"

    def __init__(self, threads, pattern):
        self.threads, self.pattern = threads, pattern

    def version(self):
        return output_of(["blender", "--version"]).splitlines()[0]

    def render(self, scene, pictures):
        jobs = [{"out": os.path.join(scene, f"cycles-{i}.exr"), **picture}
                for i, picture in enumerate(pictures)]
        job = os.path.join(scene, "job.json")
        with open(job, "w") as file:
            json.dump({"scene": scene, "threads": self.threads, "pattern": self.pattern,
                       "pictures": jobs}, file)
        text = output_of(["blender", "-b", "--factory-startup", "--python-exit-code", "1",
                          "-P", os.path.join(HERE, "blender_scene.py"), "--", job])
        times = [json.loads(line.split(" ", 1)[1]) for line in text.splitlines()
                 if line.startswith("picture ")]
        return [(read_exr(j["out"])["G"], t) for j, t in zip(jobs, times, strict=True)]


def output_of(command):
    return subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout


def read_exr(path):
    """Channels by name, rows from the top."""
    file = oiio.ImageInput.open(path)
    if file is None:
        raise SystemExit(f"{path}: {oiio.geterror()}")
    spec = file.spec()
    pixels = file.read_image(0, 0, 0, spec.nchannels, oiio.FLOAT).astype(np.float64)
    file.close()
    pixels = pixels.reshape(spec.height, spec.width, spec.nchannels)
    return {name: pixels[..., i] for i, name in enumerate(spec.channelnames)}


def write_png(path, rgb):
    """Colours of 0..1."""
    pixels = np.ascontiguousarray(np.rint(255.0 * np.clip(rgb, 0.0, 1.0)).astype(np.uint8))
    file = oiio.ImageOutput.create(path)
    if not file.open(path, oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, oiio.UINT8)):
        raise SystemExit(f"{path}: {file.geterror()}")
    file.write_image(pixels)
    file.close()

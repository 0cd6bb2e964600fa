"""Do both renderers give the same radiance? Ratios over regions of the mask, and their picture."""
import json
import os

import numpy as np

import renderers

TOLERANCE = 0.01  # of the ratio of two radiances
ZONES_DEG = ((0, 15), (15, 30), (30, 45), (45, 60), (60, 75), (75, 90))


class Mask:
    """Where in our last picture of a scene the mask is, and at which angle it is seen.

    `inside` and `rim`: pixels that are on the mask with all their eight neighbours, and those that
    are near its edge, on either side. `angle_deg` is between the normal and the way to the camera.
    """

    def __init__(self, scene):
        channels = renderers.read_exr(os.path.join(scene, "retrolux", "camera.exr"))
        with open(os.path.join(scene, "scene.json")) as file:
            camera = json.load(file)["cameras"][0]
        eye = -np.array(camera["R"]).reshape(3, 3).T @ np.array(camera["t_mm"])
        view = eye - np.stack([channels[f"position.{axis}"] for axis in "XYZ"], axis=-1)
        normal = np.stack([channels[f"normal.{axis}"] for axis in "XYZ"], axis=-1)
        cosine = np.sum(normal * view, axis=-1) / np.linalg.norm(view, axis=-1)
        self.angle_deg = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
        self.pixels = channels["id.object"] > 0
        around = [np.roll(self.pixels, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
        self.inside = np.logical_and.reduce(around)
        self.rim = np.logical_or.reduce(around) & ~self.inside


def regions(mask, radiance, rough):
    """Name, pixels, and whether the models coincide there.

    Cycles is given a rough surface for one angle (facets.py); where a degree beside the camera
    counts, at grazing views, that is not enough.
    """
    rows = [("highlight", radiance > 0.5 * radiance.max(), True)] if rough else []
    for low, high in ZONES_DEG:
        zone = mask.inside & (mask.angle_deg >= low) & (mask.angle_deg < high)
        rows.append((f"{low} to {high} deg", zone, True))
    rows.append(("rim", mask.rim, not rough))
    rows.append(("all", mask.inside | mask.rim, not rough))
    return rows


def ratio(ours, theirs):
    """Of the means of two samples, with its standard error."""
    value = np.mean(ours) / np.mean(theirs)
    scatter = [np.std(x, ddof=1) / np.mean(x) / np.sqrt(len(x)) for x in (ours, theirs)]
    return value, value * float(np.hypot(*scatter))


def compare(name, scene, both, spp, seeds):
    """Rows of the table for one material, and the mean picture of each renderer."""
    pictures = [{"spp": spp, "seed": seed} for seed in range(1, seeds + 1)]
    ours, theirs = ([picture for picture, _ in r.render(scene, pictures)] for r in both)
    means = [np.mean(pictures, axis=0) for pictures in (ours, theirs)]
    rows = []
    for region, pixels, coincide in regions(Mask(scene), means[0], rough=name != "diffuse"):
        radiances = [[picture[pixels].mean() for picture in x] for x in (ours, theirs)]
        value, error = ratio(*radiances)
        rows.append({
            "material": name,
            "region": region,
            "pixels": int(pixels.sum()),
            "retrolux_w_m2_sr": np.mean(radiances[0]),
            "cycles_w_m2_sr": np.mean(radiances[1]),
            "ratio": value,
            "standard_error": error,
            "models_coincide": coincide,
            "pass": bool(abs(value - 1.0) <= TOLERANCE) if coincide else None,
        })
    return rows, means


def difference_colours(ours, theirs, limit):
    """Red where ours is brighter, blue where Cycles is; grey where there is no light."""
    dark = theirs <= 0.0
    d = np.clip((ours / np.where(dark, 1.0, theirs) - 1.0) / limit, -1.0, 1.0)
    rgb = np.stack([1.0 + np.minimum(d, 0.0), 1.0 - np.abs(d), 1.0 - np.maximum(d, 0.0)], axis=-1)
    return np.where(dark[..., None], 0.5, rgb)


def side_by_side(pairs):
    """A row for each material: ours, Cycles (both gamma 2.2), relative difference up to 1 %."""
    rows = []
    for ours, theirs in pairs:
        row = [np.repeat((x / ours.max())[..., None], 3, axis=-1)**(1.0 / 2.2)
               for x in (ours, theirs)]
        rows.append(np.concatenate([*row, difference_colours(ours, theirs, TOLERANCE)], axis=1))
    return np.concatenate(rows, axis=0)


def print_table(rows):
    print(f"{'material':9} {'region':13} {'pixels':>7} {'retrolux':>10} {'Cycles':>10}  "
          f"W/(m2 sr)   ratio - 1")
    verdicts = {True: "", False: "  more than 1 %", None: "  (the models differ here)"}
    for row in rows:
        print(f"{row['material']:9} {row['region']:13} {row['pixels']:7} "
              f"{row['retrolux_w_m2_sr']:10.6f} {row['cycles_w_m2_sr']:10.6f} "
              f"{100 * (row['ratio'] - 1):+12.3f} % +- {100 * row['standard_error']:.3f} %"
              f"{verdicts[row['pass']]}", flush=True)

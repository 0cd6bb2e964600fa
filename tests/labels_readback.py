#!/usr/bin/env python3
"""Reads the labels of a dataset back without any of our code: BOP's and COCO's files, PNG masks.

    labels_readback.py DATASET      (a folder after `dataset export` to coco and bop)

Projects the corners of BOP's poses with a Brown-Conrady camera of its own and compares them with
dataset.json to 0.01 px; COCO's run lengths must be the pixels of mask_visib, boxes their bounds.
Python's standard library only. Exit code 1 if something differs.
"""
import json
import struct
import sys
import zlib
from pathlib import Path

LIMIT_PX = 0.01


def read_png(path):
    """(width, height, rows of bytes) of an 8-bit grey PNG."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    place, packed, header = 8, b"", None
    while place < len(data):
        (length,) = struct.unpack(">I", data[place:place + 4])
        kind, body = data[place + 4:place + 8], data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        place += 12 + length
    width, height, bits, colour, _, _, interlaced = header
    assert (bits, colour, interlaced) == (8, 0, 0), (path, header)
    raw, rows, above = zlib.decompress(packed), [], bytes(width)
    for y in range(height):
        line = raw[y * (width + 1):(y + 1) * (width + 1)]
        above = unfilter(line[0], line[1:], above)
        rows.append(above)
    return width, height, rows


def unfilter(kind, line, above):
    """A row of one byte a pixel, its PNG filter undone."""
    out = bytearray(len(line))
    for x, value in enumerate(line):
        a = out[x - 1] if x else 0
        b, c = above[x], above[x - 1] if x else 0
        p = a + b - c
        paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        out[x] = (value + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
    return bytes(out)


def pixels_of_png(path):
    _, _, rows = read_png(path)
    return {(x, y) for y, row in enumerate(rows) for x, value in enumerate(row) if value}


def pixels_of_runs(rle):
    height, _ = rle["size"]
    counts, value, shift = [], 0, 0
    for c in rle["counts"]:
        group = ord(c) - 48
        value |= (group & 31) << shift
        shift += 5
        if group & 32:
            continue
        if group & 16:
            value -= 1 << shift
        counts.append(value + (counts[-2] if len(counts) > 2 else 0))
        value = shift = 0
    pixels, place = set(), 0
    for i, count in enumerate(counts):
        if i % 2:
            pixels.update((p // height, p % height) for p in range(place, place + count))
        place += count
    return pixels


def bounds(pixels):
    xs, ys = [x for x, _ in pixels], [y for _, y in pixels]
    return [min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1]


def project(x, pose, camera):
    """OpenCV's camera model."""
    r, t, k = pose["cam_R_m2c"], pose["cam_t_m2c"], camera["cam_K"]
    k1, k2, p1, p2, k3 = camera["distortion"]
    cx, cy, cz = (sum(r[3 * i + j] * x[j] for j in range(3)) + t[i] for i in range(3))
    u, v = cx / cz, cy / cz
    r2 = u * u + v * v
    radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 ** 3
    ud = u * radial + 2 * p1 * u * v + p2 * (r2 + 2 * u * u)
    vd = v * radial + p1 * (r2 + 2 * v * v) + 2 * p2 * u * v
    return k[0] * ud + k[2], k[4] * vd + k[5]


class Failures:
    def __init__(self):
        self.count = 0

    def expect(self, good, what):
        if not good:
            self.count += 1
            print("FAIL ", what)


def check(folder):
    index = json.loads((folder / "dataset.json").read_text())
    failures, corners, masks, annotations = Failures(), 0, 0, {}
    for split in index["splits"]:
        file = folder / "coco" / f"{split}.json"
        if not file.exists():
            continue
        coco = json.loads(file.read_text())
        names = {image["id"]: image["file_name"] for image in coco["images"]}
        for a in coco["annotations"]:
            annotations[names[a["image_id"]], a["instance"]] = a
    for number, scene in enumerate(index["scenes"]):
        bop = folder / "bop" / scene["split"] / f"{number:06}"
        cameras, poses, infos = (json.loads((bop / f"{name}.json").read_text())
                                 for name in ("scene_camera", "scene_gt", "scene_gt_info"))
        for i, picture in enumerate(scene["pictures"]):
            for m, (label, pose, info) in enumerate(
                    zip(picture["markers"], poses[str(i)], infos[str(i)], strict=True)):
                where = f"{picture['file']} {label['name']}"
                for x, px in zip(pose["corners_in_marker_mm"], label["corners_px"]):
                    if px is None:
                        continue
                    u, v = project(x, pose, cameras[str(i)])
                    failures.expect(max(abs(u - px[0]), abs(v - px[1])) <= LIMIT_PX,
                                    f"{where}: corner at {u}, {v}, not {px}")
                    corners += 1
                seen = pixels_of_png(bop / "mask_visib" / f"{i:06}_{m:06}.png")
                failures.expect(seen == pixels_of_runs(label["mask_visible"]), f"{where}: mask")
                failures.expect(info["px_count_visib"] == len(seen), f"{where}: px_count_visib")
                masks += 1
                annotation = annotations.pop((Path(picture["file"]).name, label["instance"]), None)
                failures.expect((annotation is not None) == bool(seen), f"{where}: in COCO or not")
                if annotation:
                    failures.expect(seen == pixels_of_runs(annotation["segmentation"]),
                                    f"{where}: COCO's mask")
                    failures.expect(annotation["bbox"] == bounds(seen), f"{where}: box")
                    failures.expect(annotation["area"] == len(seen), f"{where}: area")
    failures.expect(not annotations, f"annotations of no label: {list(annotations)[:3]}")
    failures.expect(corners > 0 and masks > 0, "no labels")
    print(f"labels_readback: {corners} corners, {masks} masks, {failures.count} failures")
    return failures.count


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(1 if check(Path(sys.argv[1])) else 0)

"""Retrolux beside Cycles on the ring-lit oval: the same radiance? the time to the same error?

See README.md. Writes cycles.json and cycles.png to the folder --out. Exit code 3 if the radiance
of a region where the models coincide differs by more than 1 %.
"""
import argparse
import json
import os
import sys

import agreement
import renderers
import speed


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", required=True, help="folder for the results")
    parser.add_argument("--retrolux", required=True, help="the program")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)),
                        help="of both renderers; default: all that the process may use")
    parser.add_argument("--pattern", default="SOBOL",
                        choices=("SOBOL", "PROGRESSIVE_MULTI_JITTER"),
                        help="sampling pattern of Cycles")
    parser.add_argument("--only", choices=("agreement", "speed"), help="one of the two parts")
    parser.add_argument("--quick", action="store_true", help="320 x 240 px and fewer samples")
    return parser.parse_args()


def main():
    options = parse_arguments()
    out = os.path.abspath(options.out)
    quick = options.quick
    os.makedirs(out, exist_ok=True)
    both = (renderers.Retrolux(os.path.abspath(options.retrolux), options.threads),
            renderers.Cycles(options.threads, options.pattern))
    scenes = renderers.make_scenes(both[0], out, (320, 240) if quick else (640, 480))
    result = {"versions": [r.version() for r in both], "threads": options.threads,
              "pattern": options.pattern, "quick": quick, "load_before": os.getloadavg()[0]}
    good = True
    if options.only != "speed":
        result["agreement"], pairs = [], []
        for name, scene in scenes.items():
            rows, means = agreement.compare(name, scene, both, spp=16 if quick else 64, seeds=4)
            result["agreement"] += rows
            pairs.append(means)
        agreement.print_table(result["agreement"])
        renderers.write_png(os.path.join(out, "cycles.png"), agreement.side_by_side(pairs))
        good = all(row["pass"] is not False for row in result["agreement"])
    if options.only != "agreement":
        result["speed"] = speed.measure(scenes["diffuse"], both, rounds=1 if quick else 3,
                                        reference_spp=256 if quick else 512)
        speed.print_table(result["speed"])
    with open(os.path.join(out, "cycles.json"), "w") as file:
        json.dump(result, file, indent=1)
    return 0 if good else 3


if __name__ == "__main__":
    sys.exit(main())

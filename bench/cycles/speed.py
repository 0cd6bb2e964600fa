"""How long does each renderer take to the same error? The diffuse oval, relMSE 3e-5."""
import numpy as np

import agreement

TARGET = 3e-5
REFERENCE_SEED = 1000
EDGE = 16  # samples beside an edge for one elsewhere
EVEN, ADAPTIVE = "even", "adaptive"

# The pictures of each way to sample, coarse to fine. Cycles' own adaptive sampling goes by the noise
# that it finds, which has a bias; ours by the ids, which has none.
SWEEPS = {
    ("retrolux", EVEN): [{"spp": spp} for spp in (4, 8, 16, 32, 64)],
    ("retrolux", ADAPTIVE): [{"spp": spp, "edge_spp": EDGE * spp} for spp in (1, 2, 4, 8, 16)],
    ("cycles", EVEN): [{"spp": spp} for spp in (4, 8, 16, 32, 64)],
    ("cycles", ADAPTIVE): [{"spp": 1024, "threshold": t} for t in (0.2, 0.1, 0.05, 0.02, 0.01)],
}


def rel_mse(picture, reference, scale):
    """(x - r)^2 / (r^2 + 1e-4) of each pixel, radiance in units of the mean over the mask."""
    x, r = picture / scale, reference / scale
    return (x - r)**2 / (r**2 + 1e-4)


def time_to(target, times, errors):
    """When the error falls through the target: linear between logarithms; none if it does not."""
    order = np.argsort(errors)
    if not errors[order[0]] <= target <= errors[order[-1]]:
        return None
    logs = np.interp(np.log(target), np.log(errors)[order], np.log(times)[order])
    return float(np.exp(logs))


def measure(scene, both, rounds, reference_spp):
    """Render time to the target of each way to sample, with all runs; they take turns.

    Each renderer has its own reference, so that only noise counts; the scale is common. What does
    not depend on the number of samples (start-up, geometry, ids, files) is the time at which the
    line through the even sweep begins; it is left out.
    """
    by_name = {r.name: r for r in both}
    reference = [{"spp": reference_spp, "seed": REFERENCE_SEED}]
    pictures = {name: r.render(scene, reference)[0][0] for name, r in by_name.items()}
    mask = agreement.Mask(scene)
    scale = np.mean([picture[mask.pixels].mean() for picture in pictures.values()])
    runs = {way: [] for way in SWEEPS}
    for seed in range(1, rounds + 1):
        for (name, kind), sweep in SWEEPS.items():
            results = by_name[name].render(scene, [{**job, "seed": seed} for job in sweep])
            for i, (picture, time) in enumerate(results):
                error = rel_mse(picture, pictures[name], scale)
                runs[name, kind].append({"picture": i, "seed": seed, **sweep[i], **time,
                                         "rel_mse": error.mean(),
                                         "rel_mse_rim": error[mask.rim].sum() / error.size})
    result = {"rim_share_of_pixels": mask.rim.mean(), "ways": []}
    for name in by_name:
        even = sweep_of(runs[name, EVEN])
        begin = {key: np.polyfit([row["spp"] for row in even], [row[key] for row in even], 1)[1]
                 for key in ("wall_s", "cpu_s")}
        for kind in (EVEN, ADAPTIVE):
            sweep = even if kind == EVEN else sweep_of(runs[name, kind])
            errors = [row["rel_mse"] for row in sweep]
            to_target = {key: time_to(TARGET, [max(row[key] - begin[key], 1e-3) for row in sweep],
                                      errors) for key in begin}
            result["ways"].append({"renderer": name, "sampling": kind, "sweep": sweep,
                                   "left_out": begin, "to_target": to_target,
                                   "runs": runs[name, kind]})
    return result


def sweep_of(rows):
    """Least time and mean error over the rounds, of each picture of the sweep."""
    sweep = []
    for i in sorted({row["picture"] for row in rows}):
        same = [row for row in rows if row["picture"] == i]
        job = {key: same[0][key] for key in ("spp", "edge_spp", "threshold") if key in same[0]}
        sweep.append({**job,
                      "wall_s": min(row["wall_s"] for row in same),
                      "cpu_s": min(row["cpu_s"] for row in same),
                      "rel_mse": np.mean([row["rel_mse"] for row in same]),
                      "rel_mse_rim": np.mean([row["rel_mse_rim"] for row in same])})
    return sweep


def print_table(speed):
    print(f"\n{'':18} {'spp':>4} {'edges':>5} {'until':>5} {'relMSE':>9} {'of the rim':>10} "
          f"{'CPU / s':>8} {'wall / s':>8}")
    for way in speed["ways"]:
        for row in way["sweep"]:
            print(f"{way['renderer']:9}{way['sampling']:9} {row['spp']:4} "
                  f"{row.get('edge_spp', ''):5} {row.get('threshold', ''):5} "
                  f"{row['rel_mse']:9.2e} {row['rel_mse_rim']:10.2e} "
                  f"{row['cpu_s']:8.2f} {row['wall_s']:8.2f}")
    print(f"the rim: {100 * speed['rim_share_of_pixels']:.2f} % of the pixels")
    print(f"\nto relMSE {TARGET:g}, start-up left out:")
    times = {}
    for way in speed["ways"]:
        times[way["renderer"], way["sampling"]] = way["to_target"]
        print(f"{way['renderer']:9}{way['sampling']:9} CPU {seconds(way['to_target']['cpu_s'])}  "
              f"wall {seconds(way['to_target']['wall_s'])}")
    ours = times["retrolux", ADAPTIVE]
    for kind in (EVEN, ADAPTIVE):
        theirs = times["cycles", kind]
        if None not in (*ours.values(), *theirs.values()):
            print(f"Cycles {kind} / retrolux: CPU {theirs['cpu_s'] / ours['cpu_s']:.2f}, "
                  f"wall {theirs['wall_s'] / ours['wall_s']:.2f} (target 3, aim 5)")


def seconds(time):
    return "not reached" if time is None else f"{time:6.2f} s"

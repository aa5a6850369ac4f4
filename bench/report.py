"""Makes a page of the figures that bench/run.sh has measured: medians, spread, ratios, and the aims beside them."""

import argparse
import collections
import json
import statistics

import report_spheres

# Per scene and range in metres: (aimed at, at most), milliseconds for one target.
AIMS = {
    ("charlotte", "100m"): (1, 3),
    ("charlotte", "600m"): (4, 12),
    ("munich", "300m"): (8, 30),
    ("munich", "600m"): (8, 30),
    ("florence", "300m"): (8, 30),
    ("florence", "600m"): (8, 30),
    ("openfoam", "200m"): (500, 3000),
}


def read(files):
    """name without suffixes -> {aggregate: record}, and what was skipped: name -> message."""
    found, skipped = collections.defaultdict(dict), {}
    for file in files:
        for record in json.load(open(file))["benchmarks"]:
            name = record["run_name"].split("/iterations:")[0].split("/min_time:")[0].split("/process_time")[0]
            if record.get("error_occurred"):
                skipped[name] = record["error_message"]
            elif "aggregate_name" in record:
                found[name][record["aggregate_name"]] = record
    return found, skipped


def median(found, name, clock):
    return found[name]["median"][clock] if name in found else None


def spread(record, clock):
    """Coefficient of variation over the repetitions, per cent."""
    return 100 * record["stddev"][clock] / record["mean"][clock] if record["mean"][clock] else 0


def show(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}" if value < 1000 else f"{value:.0f}"


def order(name):
    """Scenes in the order of the aims, then target and range."""
    _, scene, target, distance, _ = name.split("/")
    scenes = [s for s, _ in AIMS]
    return scenes.index(scene) if scene in scenes else len(scenes), scene, target, int(distance[:-1])


def aims_cell(scene, distance, measured):
    if (scene, distance) not in AIMS:
        return "-"
    aim, most = AIMS[scene, distance]
    verdict = "met" if measured <= aim else "within" if measured <= most else "**missed**"
    return f"{aim}, {most}: {verdict}"


def engine_table(found):
    print("| scene | target | range | CPU, one thread | spread | least | wall, one thread | wall, all threads | facets "
          "| visible blockers | aim, at most |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name in sorted((n for n in found if n.startswith("engine/") and n.endswith("/one")), key=order):
        _, scene, target, distance, _ = name.split("/")
        one, everyone = found[name], name[:-3] + "all"
        print(f"| {scene} | {target} | {distance} | **{show(one['median']['cpu_time'])}** | {spread(one, 'cpu_time'):.0f} % "
              f"| {show(one['min']['cpu_time'])} | {show(one['median']['real_time'])} "
              f"| {show(median(found, everyone, 'real_time'))} | {one['median']['facets']:.0f} "
              f"| {one['median']['visible_blockers']:.0f} | {aims_cell(scene, distance, one['median']['cpu_time'])} |")
    print()


def ratio_line(found, title, over, under, limit):
    """Ratios of the medians of CPU time, target by target; `over` and `under` are patterns with {} for the target."""
    ratios, seen = [], []
    for k in range(1, 100):
        a, b = (median(found, p.format(f"T{k}"), "cpu_time") for p in (over, under))
        if a is None or b is None:
            break
        ratios.append(a / b)
        counts = [found[p.format(f"T{k}")]["median"].get("visible_blockers") for p in (over, under)]
        seen.append(f" ({counts[0] / counts[1]:.2f})" if all(counts) else "")
    if ratios:
        print(f"| {title} | {', '.join(f'{r:.2f}{s}' for r, s in zip(ratios, seen))} | {statistics.median(ratios):.2f} "
              f"| {max(ratios):.2f} | {limit} |")


def ratio_table(found):
    print("In brackets the ratio of the blockers that are visible: 1.00 where the farther range shows nothing new.\n")
    print("| CPU time, one thread | each target | median | worst | at most |")
    print("|---|---|---|---|---|")
    for scene in ("munich", "florence"):
        ratio_line(found, f"{scene}: 600 m over 300 m", f"engine/{scene}/{{}}/600m/one", f"engine/{scene}/{{}}/300m/one",
                   1.5)
    ratio_line(found, "munich 5 x 5 over munich, 300 m", "engine/munich_5x5/{}/300m/one", "engine/munich/{}/300m/one",
               1.3)
    ratio_line(found, "plain union over engine, charlotte 100 m", "plain/charlotte/{}/100m/one",
               "engine/charlotte/{}/100m/one", "-")
    print()


def plain_table(found):
    names = sorted((n for n in found if n.startswith("plain/") and n.endswith("/one")), key=order)
    if not names:
        return
    print("The plain alternative: the range region (made beforehand, with the same tolerance) minus the union of one "
          "convex hull per scene triangle, by Manifold.\n")
    print("| scene | target | range | CPU, one thread | spread | wall, all threads | facets | volume m3 | engine's m3 |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name in names:
        _, scene, target, distance, _ = name.split("/")
        one, other = found[name], found.get("engine" + name[5:], {}).get("median", {})
        print(f"| {scene} | {target} | {distance} | **{show(one['median']['cpu_time'])}** | {spread(one, 'cpu_time'):.0f} % "
              f"| {show(median(found, name[:-3] + 'all', 'real_time'))} | {one['median']['facets']:.0f} "
              f"| {one['median']['volume_m3']:.1f} | {other.get('volume_m3', float('nan')):.1f} |")
    print()


def prepare_table(found):
    names = [n for n in found if n.startswith("prepare/")]
    if not names:
        return
    print("Preparing, all threads; the peak memory is of the whole process, the scene as read included. At most 3 s and "
          "1500 MB for munich_5x5.\n")
    print("| scene | triangles | wall s | CPU s | peak MB |")
    print("|---|---|---|---|---|")
    for name in names:
        m = found[name]["median"]
        print(f"| {name.split('/')[1]} | {m['triangles']:.0f} | {show(m['real_time'] / 1e3)} "
              f"| {show(m['cpu_time'] / 1e3)} | {m['peak_MB']:.0f} |")
    print()


def inputs(found):
    print("Targets: charlotte T1 to T3 are those of its baseline.json; the others equilateral triangles with sides of "
          "20 m: in openfoam just over a roof, in the others level on the ground, drawn at random with a fixed seed (bench/support/street_targets.h).\n")
    seen = set()
    for name in sorted((n for n in found if n.startswith("engine/")), key=order):
        _, scene, target, _, _ = name.split("/")
        if (scene, target) not in seen:
            seen.add((scene, target))
            print(f"- {scene} {target}: {found[name]['median']['label']}")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for option in ("commit", "cpu", "threads", "load"):
        parser.add_argument("--" + option, required=True)
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    found, skipped = read(arguments.files)
    print(f"# Measured: {arguments.cpu}, {arguments.threads} threads\n")
    print(f"Commit {arguments.commit}; load average before and after: {arguments.load}. Medians of repetitions in "
          "milliseconds unless said otherwise; spread is the standard deviation over the mean. CPU time is of all "
          "threads of the process. When others use the machine (a load above 1 before the start) only the CPU times of "
          "one thread mean much; wall times are then too long.\n")
    if any(name.startswith("engine/") for name in found):
        inputs(found)
        engine_table(found)
        ratio_table(found)
    plain_table(found)
    prepare_table(found)
    report_spheres.depth_table(found, show)
    report_spheres.volume_table(found, show)
    for name, message in sorted(skipped.items()):
        if not name.endswith("/gpu"):  # the list of devices tells of a graphics processor that is not there
            print(f"- skipped: {name}: {message}")


if __name__ == "__main__":
    main()

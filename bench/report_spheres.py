"""The part of the benchmarks' page that is about the spheres method: depth images and whole volumes, with the aims."""

# Texels a face side: at most so many milliseconds for three spheres and their intersection.
AIMS_MS = {40: 150, 200: 1500}
DEVICES = ("cpu", "opengl", "gpu")


def cell(found, name, show):
    """Median and spread of the wall time."""
    if name not in found:
        return "-"
    record = found[name]
    return f"{show(record['median']['real_time'])} ({100 * record['stddev']['real_time'] / record['mean']['real_time']:.0f} %)"


def depth_table(found, show):
    images = sorted({tuple(name.split("/")[1:4]) for name in found if name.startswith("depth/")},
                    key=lambda image: (image[0], int(image[1]), image[2]))
    if not images:
        return
    labels = {device: next((found[name]["median"].get("label", "") for name in found
                            if name.startswith("depth/") and name.endswith("/" + device)), "not there: skipped")
              for device in DEVICES}
    print("## Depth images\n")
    print("Six faces of one viewpoint, read back, the scene uploaded before; wall milliseconds, all threads, in brackets "
          "the spread. `centers`: the depth at texel centres; `nearest`: the nearest over each texel's whole footprint, "
          "which conservative spheres need.\n")
    for device, label in labels.items():
        print(f"- {device}: {label}")
    print(f"\n| scene | texels a face side | sampling | {' | '.join(DEVICES)} |")
    print("|---|---|---|---|---|---|")
    for scene, size, sampling in images:
        cells = [cell(found, f"depth/{scene}/{size}/{sampling}/{device}", show) for device in DEVICES]
        print(f"| {scene} | {size} | {sampling} | {' | '.join(cells)} |")
    print()


def verdict(size, milliseconds):
    if size not in AIMS_MS:
        return "-"
    return f"{AIMS_MS[size]}: {'met' if milliseconds <= AIMS_MS[size] else '**missed**'}"


def volume_table(found, show):
    names = sorted((name for name in found if name.startswith("spheres/")),
                   key=lambda name: (name.split("/")[2:4], int(name.split("/")[4]), name))
    if not names:
        return
    print("## Three spheres and their intersection\n")
    print("From the prepared scene to the closed volume, without splits: opening the device, uploading, rendering, "
          "tessellating, booleans. Beside it the exact engine's time for the same target in the same run.\n")
    print("| target | range | texels | sphere | wall ms | spread | CPU ms | of it rendering, wall | booleans, wall | facets "
          "| at most | exact, wall ms |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for name in names:
        _, scene, target, distance, size, sphere = name.split("/")
        median, record = found[name]["median"], found[name]
        exact = found.get(f"engine/{scene}/{target}/{distance}/all", {}).get("median", {}).get("real_time")
        spread = 100 * record["stddev"]["real_time"] / record["mean"]["real_time"]
        print(f"| {scene} {target} | {distance} | {size} | {sphere} | **{show(median['real_time'])}** | {spread:.0f} % "
              f"| {show(median['cpu_time'])} | {show(median['render_ms'])} | {show(median['boolean_ms'])} "
              f"| {median['facets']:.0f} | {verdict(int(size), median['real_time'])} | {show(exact)} |")
    print()

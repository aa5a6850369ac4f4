#!/usr/bin/env python3
"""Measures fields of shares: the gallery's square in Munich, a cube of voxels about it, exact and sampled.

    PYTHONPATH=build/python measure.py [--side 256] [--step 2] [--samples 256] [--device cpu ...] [--skip-exact]

Prints seconds (of the clock, and of all cores), voxels that were looked from, and errors at 10,000 voxels against exact
shares. The scene is looked for in ../shared beside the checkout, or where VANTAGE_SHARED says.
"""

import argparse
import os
import pathlib
import resource
import time

import numpy as np

import vantage as vt

SHARED = pathlib.Path(os.environ.get("VANTAGE_SHARED", pathlib.Path(__file__).resolve().parents[3] / "shared"))
SQUARE = [[-5, -112, 0], [25, -112, 0], [22, -97, 0], [-8, -97, 0]]
CENTRE = np.array([8.5, -104.5])
SEED = 20261123


class Stages:
    """Seconds of each stage."""

    def __init__(self):
        self.began, self.seconds = {}, {}

    def __call__(self, stage, part):
        now = time.perf_counter()
        self.seconds[stage] = now - self.began.setdefault(stage, now)


def measured(name, work):
    stages = Stages()
    clock, cpu = time.perf_counter(), time.process_time()
    field = work(stages)
    print(f"{name}: {time.perf_counter() - clock:.1f} s, {time.process_time() - cpu:.1f} s of all cores; "
          + ", ".join(f"{stage} {seconds:.1f} s" for stage, seconds in stages.seconds.items()))
    evaluated = field.attrs["voxels_evaluated"]
    print(f"  {evaluated:,} of {field.size:,} voxels looked from ({100 * evaluated / field.size:.1f} %); largest memory "
          f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB", flush=True)
    return field


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--side", type=int, default=256)
    parser.add_argument("--step", type=float, default=2)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--device", nargs="*", default=["cpu"])
    parser.add_argument("--skip-exact", action="store_true")
    options = parser.parse_args()
    scene = vt.Scene.from_mesh(SHARED / "data/mesh/munich_merged.ply").prepare()
    length = options.side * options.step
    low = [*(CENTRE - length / 2).tolist(), 0]
    box = (low, [v + length for v in low])
    chosen = np.unravel_index(np.random.default_rng(SEED).integers(0, options.side**3, 10_000), (options.side,) * 3)
    print(f"{options.side}^3 voxels of {options.step:g} m, {os.cpu_count()} cores, seed {SEED}")
    sampled = {}
    for device in options.device:
        sampled[device] = measured(f"{options.samples} samples, {device}", lambda told, device=device: vt.fraction_field(
            scene, SQUARE, box, options.step, samples=options.samples, device=device, progress=told))
    if not options.skip_exact:
        exact = measured("exact", lambda told: vt.fraction_field(scene, SQUARE, box, options.step, progress=told))
        none, whole = (exact.values == 0).mean(), (exact.values == 1).mean()
        print(f"  nothing seen {100 * none:.1f} %, a part {100 * (1 - none - whole):.1f} %, all {100 * whole:.1f} %")
    some = next(iter(sampled.values())) if sampled else exact
    places = np.column_stack([some[axis].values[index] for axis, index in zip("xyz", chosen[::-1])])
    shares = vt.Mission.of(scene, SQUARE, max_range=1000).fraction(places)
    if not options.skip_exact:
        print(f"exact: {(exact.values[chosen] == shares).sum()} of 10,000 equal to Mission.fraction")
    for device, field in sampled.items():
        errors = np.abs(field.values[chosen] - shares)
        print(f"{device}: errors at 10,000: mean {errors.mean():.4f}, 95 % {np.quantile(errors, 0.95):.4f}, worst "
              f"{errors.max():.4f}; 1 / sqrt(samples) is {options.samples**-0.5:.4f}")
        partly = (shares > 0) & (shares < 1)
        print(f"  of the {partly.sum()} that see a part: mean {errors[partly].mean():.4f}, 95 % "
              f"{np.quantile(errors[partly], 0.95):.4f}, worst {errors[partly].max():.4f}")
    if len(sampled) == 2:
        first, second = sampled.values()
        lookups = np.abs(first.values - second.values) * options.samples
        print(f"devices: {lookups.sum():.0f} look-ups of {first.attrs['voxels_evaluated'] * options.samples:,} differ, in "
              f"{(lookups > 0).sum()} voxels, {lookups.max():.0f} at the most in one")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Forges certificates by hand, and sees tools/check_certificate.py refuse them. Needs no program of vantage.

    forge_certificates.py [--mutants N] [--seed S] [--only TEXT]

Each change of a sound certificate has the exit code that it must get. Mutants (N of the certificate, the volume and the
scene each) must never end in a traceback, and never be accepted unless what is then claimed is true: positions are
drawn in the volume, and their view, range and front are computed from the files as other programs read them.
"""

import argparse
import contextlib
import io
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

TOOL = pathlib.Path(__file__).resolve().parent.parent.parent / "tools" / "check_certificate.py"
sys.path.insert(0, str(TOOL.parent))
import check_certificate as checker  # noqa: E402
from forged_files import EAST, TOWN, block, files, joined  # noqa: E402
from mutants import mutant, statement_in  # noqa: E402
from single_changes import CHANGES, HIGH, POINT, cover, put, raised_past, ranges, two_parts  # noqa: E402
from what_is_false import what_is_false  # noqa: E402

LONGEST_S = 20  # of one check


def verdict(folder, most_s=LONGEST_S):
    """The exit code, and what is said."""
    told, begin = io.StringIO(), time.monotonic()
    with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
        code = checker.main([str(folder / "volume.cert")])  # whatever is raised here would be a traceback
    if time.monotonic() - begin > most_s:
        raise AssertionError(f"the check took {time.monotonic() - begin:.0f} s")
    return code, told.getvalue().strip()


def written(folder, content):
    for old in folder.iterdir():
        old.unlink()
    for name, data in content.items():
        (folder / name).write_bytes(data)
    return folder


def check_changes(folder, numbers, only):
    """Names and numbers of what is not as it must be."""
    failures = []
    for name, code, change in CHANGES:
        if only and only not in name:
            continue
        written(folder, files(**change))
        try:
            got, told = verdict(folder)
        except Exception as problem:  # whatever it is
            got, told = "traceback", f"{type(problem).__name__}: {problem}"
        false = what_is_false(folder, numbers) if got == 0 else ""
        if only:
            print(f"{name}: {got} {told}")
        if got != code or false or any(ord(c) < 32 and c != "\n" for c in told):  # control characters
            failures.append(f"{name}: {got} instead of {code}: {told[-200:]} {false}")
    return failures


def check_lift_of_any_size(folder):
    """That a lift is bounded even if coordinates were not: k and the height of the target's own surface are, too."""
    far = [(1e14, 0.0, 0.0), (1e14, 9.0, 0.0), (1e14, 0.0, -9.0)], [(0, 1, 2)]
    largest, checker.LARGEST = checker.LARGEST, float("inf")
    failures = []
    for height, lift in ((1.9, 2.0), (1.9, 1.9003), (0.0039, 0.005), (-1.0, 0.0021)):
        code, told = verdict(written(folder, files(**raised_past(height, lift, far))))
        if code != 1 or "raised by more" not in told:
            failures.append(f"a lift of {lift} m past a plate at {height} m, a scene of 1e14 m: {code} {told[-200:]}")
    checker.LARGEST = largest
    return failures


def check_what_leans_over(folder):
    """That what begins below a raised target and ends a little above it is refused for that, whatever the range is."""
    leaning = [(-3.0, -3.0, 0.1001), (3.0, -3.0, 0.1001), (0.0, 3.0, 0.1015)], [(0, 1, 2)]
    top_m = 0.0001 + 0.0014 * 5 / 6  # of it, over the target
    change = dict(ranges(1e9), scene=joined(TOWN, leaning), volume=HIGH, shift=(0.0, top_m - 5e-6))
    code, told = verdict(written(folder, files(**change)))
    return [] if code == 1 and "something lies between" in told else [f"it leans over a target: {code} {told[-200:]}"]


def check_what_is_false(folder, numbers):
    """That wrong claims are found to be so, whatever the checker says."""
    wrong = {"hidden": dict(volume=EAST), "range": dict(volume=block((-200, -9, 0.2), (-9, 9, 9))),
             "behind": dict(volume=block((-9, -9, -9), (-5, 9, 9))),
             "box": put(boxes=[{"name": "altitude", "min": [None, None, 9], "max": [None] * 3}])}
    failures = [] if not what_is_false(written(folder, files()), numbers) else ["a right volume is called wrong"]
    return failures + [f"nobody sees that it is wrong: {why}" for why, change in wrong.items()
                       if why not in what_is_false(written(folder, files(**change)), numbers)]


def check_special_files(folder):
    """What is no file: a pipe would be waited for, and a device has no end."""
    failures = []
    for name, make in (("a pipe", os.mkfifo), ("a device", lambda p: p.symlink_to("/dev/zero"))):
        for of in ("volume.ply", "volume.scene.ply", "volume.cert"):
            written(folder, files())
            (folder / of).unlink()
            make(folder / of)
            try:
                done = subprocess.run([sys.executable, str(TOOL), str(folder / "volume.cert")], capture_output=True,
                                      text=True, timeout=LONGEST_S, check=False)
            except subprocess.TimeoutExpired:
                failures.append(f"{name} as {of}: is waited for")
                continue
            if done.returncode != 2 or "Traceback" in done.stderr:
                failures.append(f"{name} as {of}: {done.returncode} {done.stderr[-200:]}")
    return failures


def what_changed(folder, content, numbers):
    """Of a mutant that was accepted: what it claims more than the files that it was made of, or what is false."""
    claims, sound = json.loads((folder / "volume.cert").read_bytes()), json.loads(content["volume.cert"])
    said = statement_in((folder / "volume.ply").read_bytes())
    if said:
        targets = [view[0] for view in said["views"]] if "views" in said else [said["target"]]
        stated = [part for target in targets for part in target["parts"]]
        if [p["target"] for p in claims["parts"]] != stated:
            return "the target is another one"
        if claims["max_range_m"] > said["max_range_m"]:
            return "the range is longer"
    elif claims["parts"][0]["target"] != sound["parts"][0]["target"] and not what_is_false(folder, numbers):
        return ""  # it says so, and that the volume does not
    return what_is_false(folder, numbers)


def check_mutants(folder, seed, count):
    failures = []
    sound = [files(), files(**two_parts()), files(**cover(0.0015, 0.001501)), files(**POINT),
             files(**put(boxes=[{"name": "altitude", "min": [None, None, 0], "max": [None, None, 30]}]))]
    for content in sound:
        written(folder, content)
        if verdict(folder)[0] != 0:
            raise AssertionError("what mutants are made of is not accepted: " + verdict(folder)[1])
    for of in ("volume.cert", "volume.ply", "volume.scene.ply"):
        answers, slowest = {0: 0, 1: 0, 2: 0}, 0.0
        for i in range(count):
            numbers = random.Random(f"{seed} {of} {i}")
            content = numbers.choice(sound)
            written(folder, mutant(content, of, numbers))
            begin = time.monotonic()
            try:
                code, told = verdict(folder)
            except Exception as problem:  # whatever it is
                failures.append(f"mutant {i} of {of}: {type(problem).__name__}: {problem}")
                continue
            slowest = max(slowest, time.monotonic() - begin)
            answers[code] += 1
            try:
                false = what_changed(folder, content, numbers) if code == 0 else ""
            except Exception as problem:  # whatever it is: others cannot read it
                false = f"{type(problem).__name__}: {problem}"
            if false:
                failures.append(f"mutant {i} of {of} is accepted: {false}: {told[-200:]}")
        print(f"{count} mutants of {of}: {answers[0]} accepted, {answers[1]} refused, {answers[2]} not read; "
              f"the slowest took {slowest:.2f} s")
        if count >= 100 and min(answers.values()) < count // 50:
            failures.append(f"hardly any mutant of {of} ends in one of the three ways: {answers}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mutants", type=int, default=300, help="of each of the three files (300)")
    parser.add_argument("--seed", type=int, default=20261125, help="of the mutants (20261125)")
    parser.add_argument("--only", default="", help="the single changes with this in their name, and what is said")
    options = parser.parse_args()
    print("seed", options.seed)
    numbers = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        failures = check_changes(folder, numbers, options.only)
        if not options.only:
            failures += check_what_is_false(folder, numbers)
            failures += check_lift_of_any_size(folder) + check_what_leans_over(folder)
            failures += check_special_files(folder)
            failures += check_mutants(folder, options.seed, options.mutants)
    for failure in failures:
        print(failure)
    print(f"{len(CHANGES)} single changes, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

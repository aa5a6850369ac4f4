#!/usr/bin/env python3
"""Makes tables and a plot of what vantage_gap has measured. No packages needed.

    report.py [--plot gap.svg] CASES.csv...     prints Markdown
"""

import argparse
import collections
import csv
import math
import pathlib
import statistics

COLOURS = {"baseline": "#1d2b45", "charlotte": "#346ebe", "munich": "#d55e00", "florence": "#009e73", "etoile": "#9a5fb4"}
DARK, GREY = "#1d2b45", "#c9ced6"
FLOOR = 1e-4  # per cent; what is less is drawn here


def read(files):
    """(city, range, sphere, split, texels, max_splits) -> rows, with the shares in per cent of the exact volume."""
    cases = collections.defaultdict(list)
    for file in files:
        for row in csv.DictReader(open(file, encoding="utf-8")):
            exact = float(row["exact_m3"])
            if exact <= 0:
                continue
            row["over"] = 100 * float(row["over_m3"]) / exact
            row["missing"] = 100 * float(row["missing_m3"]) / exact
            key = (row["city"], float(row["range_m"]), row["sphere"], row["split"], int(row["texels"]),
                   int(row["max_splits"]))
            cases[key].append(row)
    return cases


def share(values):
    """Median and the largest, per cent."""
    return f"{statistics.median(values):.3g} ({max(values):.3g})"


def total(rows, key):
    return sum(int(row[key]) for row in rows)


def figures(rows, split):
    """What a row of the table says of a case. A pair fails the test when it is split or left unresolved; with
    max_splits 0 no pair is tested."""
    is_tested = split == "euler" and total(rows, "pairs") > 0
    failed = total(rows, "splits") + total(rows, "unresolved") if is_tested else "-"
    return (f"{len(rows)} | {share([row['over'] for row in rows])} | {share([row['missing'] for row in rows])} | "
            f"{statistics.mean(int(row['spheres']) for row in rows):.3g} | {failed} | {total(rows, 'unresolved')}")


def table(cases):
    """Neighbouring max_splits with the same result share a row."""
    lines = ["| scene | range | sphere | split | texels | max_splits | targets | over, % | missed, % | spheres | "
             "failed | unresolved |",
             "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    runs = []  # (key without max_splits, first, last, figures)
    for key in sorted(cases):
        said = figures(cases[key], key[3])
        if runs and runs[-1][0] == key[:5] and runs[-1][3] == said:
            runs[-1][2] = key[5]
        else:
            runs.append([key[:5], key[5], key[5], said])
    for (city, distance, sphere, split, texels), first, last, said in runs:
        splits = f"{first}" if first == last else f"{first} to {last}"
        lines.append(f"| {city} | {distance:g} m | {sphere} | {split} | {texels} | {splits} | {said} |")
    return "\n".join(lines)


class Panel:
    """A plot with a logarithmic vertical axis, in per cent."""

    def __init__(self, left, title, ticks, label, low=FLOOR, high=100.0):
        self.left, self.top, self.width, self.height = left, 60, 330, 300
        self.ticks, self.low, self.high = ticks, math.log10(low), math.log10(high)
        self.parts = [self.text(left, 34, title, size=16, weight="bold")]
        for power in range(round(self.low), round(self.high) + 1):
            y = self.y(10.0 ** power)
            self.parts.append(f'<line x1="{left}" x2="{left + self.width}" y1="{y:.1f}" y2="{y:.1f}" stroke="{GREY}"/>')
            self.parts.append(self.text(left - 8, y + 4, f"{10.0 ** power:g} %", anchor="end"))
        for place, words in enumerate(ticks):
            self.parts.append(self.text(self.x(place), self.top + self.height + 20, words, anchor="middle"))
        self.parts.append(self.text(left + self.width / 2, self.top + self.height + 42, label, anchor="middle"))

    def x(self, place):
        return self.left + self.width * (place + 0.5) / len(self.ticks)

    def y(self, value):
        share_of_height = (math.log10(max(value, 10 ** self.low)) - self.low) / (self.high - self.low)
        return self.top + self.height * (1 - share_of_height)

    @staticmethod
    def text(x, y, words, anchor="start", size=13, weight="normal", fill=DARK):
        return (f'<text x="{x:.1f}" y="{y:.1f}" fill="{fill}" text-anchor="{anchor}" font-size="{size}" '
                f'font-weight="{weight}" font-family="Helvetica, Arial, sans-serif">{words}</text>')

    def curve(self, points, colour, dash=""):
        """(place, median) pairs."""
        if not points:
            return
        where = " ".join(f"{self.x(p):.1f},{self.y(v):.1f}" for p, v in points)
        style = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<polyline points="{where}" fill="none" stroke="{colour}" stroke-width="2"{style}/>')
        for p, v in points:
            self.parts.append(f'<circle cx="{self.x(p):.1f}" cy="{self.y(v):.1f}" r="3" fill="{colour}"/>')


def points_of(cases, place_of, wanted, column, of_targets):
    """city -> [(place, median or worst)] of the cases that `wanted` takes."""
    curves = collections.defaultdict(list)
    for key in sorted(cases):
        if wanted(*key) and place_of(*key) is not None:
            curves[key[0]].append((place_of(*key), of_targets(row[column] for row in cases[key])))
    return curves


def draw(cases, distance, file):
    sizes = sorted({key[4] for key in cases})
    splits = sorted({key[5] for key in cases})
    most = max(sizes, key=lambda size: len({key[5] for key in cases if key[4] == size and key[3] == "always"}))
    splits = [n for n in splits if any(key[3] == "always" and key[4] == most and key[5] == n for key in cases)]

    def at_size(sphere):
        return lambda city, d, s, split, texels, n: d == distance and s == sphere and split == "euler" and n == 0

    def at_split(sphere):
        return lambda city, d, s, split, texels, n: (d == distance and s == sphere and split == "always" and
                                                     texels == most)

    def size_place(city, d, s, split, texels, n):
        return sizes.index(texels)

    def split_place(city, d, s, split, texels, n):
        return splits.index(n) if n in splits else None

    words = [str(size) for size in sizes]
    panels = [Panel(80, "over-claimed, median", words, "texels a face side"),
              Panel(500, "missed, median", words, "texels a face side"),
              Panel(920, f"over-claimed, worst, {most} texels", [str(n) for n in splits], "halvings of every edge")]
    for panel, place, choose, column, of_targets in (
            (panels[0], size_place, at_size, "over", statistics.median),
            (panels[1], size_place, at_size, "missing", statistics.median),
            (panels[2], split_place, at_split, "over", max)):
        for sphere, dash in (("conservative", ""), ("centers", "6 4")):
            for city, points in points_of(cases, place, choose(sphere), column, of_targets).items():
                panel.curve(points, COLOURS.get(city, DARK), dash)
    parts = [part for panel in panels for part in panel.parts]
    x = 80
    for city in sorted({key[0] for key in cases}, key=list(COLOURS).index):
        parts.append(f'<line x1="{x}" x2="{x + 26}" y1="436" y2="436" stroke="{COLOURS[city]}" stroke-width="3"/>')
        parts.append(Panel.text(x + 32, 440, city))
        x += 125
    for words, dash in (("conservative", ""), ("centers", "6 4")):
        parts.append(f'<line x1="{x}" x2="{x + 26}" y1="436" y2="436" stroke="{DARK}" stroke-width="2" '
                     f'stroke-dasharray="{dash}"/>')
        parts.append(Panel.text(x + 32, 440, words))
        x += 140
    head = ('<svg xmlns="http://www.w3.org/2000/svg" width="1280" height="460" viewBox="0 0 1280 460">\n'
            '<rect width="100%" height="100%" fill="white"/>\n')
    pathlib.Path(file).write_text(head + "\n".join(parts) + "\n</svg>\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description="Tables and a plot of what vantage_gap has measured.")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--plot")
    parser.add_argument("--range", type=float, default=300, help="of the plot, metres")
    arguments = parser.parse_args()
    cases = read(arguments.files)
    print(table(cases))
    if arguments.plot:
        draw(cases, arguments.range, arguments.plot)


if __name__ == "__main__":
    main()

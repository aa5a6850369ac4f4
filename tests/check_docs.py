#!/usr/bin/env python3
"""Checks the text of the documents: README.md, CONTRIBUTING.md, CHANGELOG.md, SECURITY.md and docs/.

    check_docs.py [ROOT]      exit 1 and one line for each problem
    check_docs.py --self-test

- No line has more than 120 characters, web addresses not counted.
- Every link within the project leads to a file that exists, and to a heading that it has.
- Words that readers do not know are not used: see WORDS.
- The tests that tests/attacks.md names are there.
"""

import argparse
import pathlib
import re
import sys
import tempfile

WIDTH = 120
LINK = re.compile(r"\]\(([^)\s]+)\)|^\[[^\]]+\]: (\S+)$", re.MULTILINE)
ADDRESS = re.compile(r"https?://[^\s)>]+")
FENCED = re.compile(r"^\s*```.*?^\s*```", re.MULTILINE | re.DOTALL)

# What is not said, and what is said instead.
WORDS = {
    r"goes before": "overrides",
    r"sight rays?": "occlusion ray",
    r"seed paper": "the paper",
    r"hand's breadth": "a length in metres",
    r"of its own accord": "without being asked",
    r"lies? askew": "is rotated",
    r"passed over": "ignored",
    r"caveats?": "warnings",
    r"chart of directions": "octahedral map",
    r"what people know": "the thing itself",
}


def anchors(text: str) -> set[str]:
    """The headings of a document, as links name them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", FENCED.sub("", text), re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
        found.add(re.sub(r"[^\w\- ]", "", plain).replace(" ", "-"))
    return found


def documents(root: pathlib.Path) -> list[pathlib.Path]:
    files = [root / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")]
    return [file for file in [*files, *sorted((root / "docs").rglob("*.md"))] if file.is_file()]


def link_problem(file: pathlib.Path, target: str) -> str:
    """What is wrong with a link of `file`; empty if nothing is."""
    if re.match(r"[a-z]+:", target):
        return ""
    path, _, anchor = target.partition("#")
    linked = (file.parent / path) if path else file
    if not linked.exists():
        return f"there is no {path}"
    if anchor and anchor not in anchors(linked.read_text(encoding="utf-8")):
        return f"{linked.name} has no heading #{anchor}"
    return ""


def header_problems(root: pathlib.Path) -> list[str]:
    """Public headers that vantage.h or the table of docs/libraries.md leaves out, or names without their being there; and
    those without an example that includes them first."""
    there = {file.stem for file in (root / "include" / "vantage").glob("*.h")} - {"vantage"}
    if not there:
        return []
    included = set(re.findall(r'#include "vantage/(\w+)\.h"', (root / "include" / "vantage" / "vantage.h").read_text()))
    table = (root / "docs" / "libraries.md").read_text(encoding="utf-8").partition("| library | headers |")[2].partition("\n\n")[0]
    listed = {name for row in table.splitlines()[2:] for name in re.findall(r"`(\w+)`", row.split("|")[2])}
    examples = {file.stem for file in (root / "examples" / "headers").glob("*.cpp")
                if re.search(r'#include "vantage/(\w+)\.h"', file.read_text(encoding="utf-8"))[1] == file.stem}
    found = [f"{file}: {name}.h is {'left out' if name in there else 'named, and is not there'}"
             for file, names in (("include/vantage/vantage.h", included), ("docs/libraries.md", listed))
             for name in sorted(names ^ there)]
    return found + [f"examples/headers: {name}.h has no example that includes it first" for name in sorted(there - examples)]


def attack_problems(root: pathlib.Path) -> list[str]:
    """Tests that tests/attacks.md names, and that are not there."""
    table = root / "tests" / "attacks.md"
    if not table.is_file():
        return []
    text = table.read_text(encoding="utf-8")
    named = {f"{suite}.{name}" for suite, name in re.findall(r"`([A-Z]\w*)\.([A-Z]\w*)`", text)}
    named |= set(re.findall(r"`(test_\w+)[`\[]", text))
    there: set[str] = set()
    for file in (root / "tests").glob("*.cpp"):
        there |= {f"{suite}.{name}" for suite, name in
                  re.findall(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)", file.read_text(encoding="utf-8"), re.MULTILINE)}
    for file in [*(root / "tests").glob("*.py"), *(root / "python" / "tests").glob("*.py")]:
        there |= set(re.findall(r"^ *def (test_\w+)", file.read_text(encoding="utf-8"), re.MULTILINE))
    return [f"tests/attacks.md: there is no test {name}" for name in sorted(named - there)]


def problems(root: pathlib.Path) -> list[str]:
    found = header_problems(root) + attack_problems(root)
    for file in documents(root):
        place = file.relative_to(root).as_posix()
        text = file.read_text(encoding="utf-8")
        for number, line in enumerate(text.splitlines(), 1):
            length = len(ADDRESS.sub("", line))
            if length > WIDTH:
                found.append(f"{place}:{number}: {length} characters, more than {WIDTH}")
            for word, better in WORDS.items():
                if re.search(rf"\b({word})\b", line, re.IGNORECASE):
                    found.append(f"{place}:{number}: '{re.search(word, line, re.IGNORECASE)[0]}'; better: {better}")
        for match in LINK.finditer(FENCED.sub("", text)):
            problem = link_problem(file, match[1] or match[2])
            if problem:
                found.append(f"{place}: {problem}")
    return found


# (text of a document, what is said of it; empty: nothing)
SELF_TEST = [
    ("x" * 120 + "\n", ""),
    ("x" * 121 + "\n", "121 characters"),
    ("é" * 120 + "\n", ""),
    ("see https://example.org/" + "x" * 120 + "\n", ""),
    ("# One, two\n[a](#one-two)\n", ""),
    ("# One\n[a](#two)\n", "no heading #two"),
    ("[a](b.md)\n", "no b.md"),
    ("[a]\n\n[a]: b.md\n", "no b.md"),
    ("[a](README.md)\n", ""),
    ("`--method` goes before it\n", "overrides"),
]


def self_test() -> list[str]:
    wrong = []
    for text, expected in SELF_TEST:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            (root / "README.md").write_text(text, encoding="utf-8")
            found = problems(root)
        if bool(found) != bool(expected) or any(expected not in line for line in found):
            wrong.append(f"{text[:40]!r}: expected '{expected}', got {found}")
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        for folder in ("include/vantage", "docs", "examples/headers"):
            (root / folder).mkdir(parents=True)
        (root / "examples" / "headers" / "one.cpp").write_text('#include "vantage/one.h"\n', encoding="utf-8")
        (root / "examples" / "headers" / "two.cpp").write_text('#include "vantage/one.h"\n', encoding="utf-8")
        for name in ("one", "two", "vantage"):
            (root / "include" / "vantage" / f"{name}.h").write_text("", encoding="utf-8")
        (root / "include" / "vantage" / "vantage.h").write_text('#include "vantage/one.h"\n', encoding="utf-8")
        (root / "docs" / "libraries.md").write_text("| library | headers |\n| --- | --- |\n| `core` | `two`, `none` |\n| | `one` |\n",
                                                    encoding="utf-8")
        expected = ["include/vantage/vantage.h: two.h is left out", "docs/libraries.md: none.h is named, and is not there",
                    "examples/headers: two.h has no example that includes it first"]
        if problems(root) != expected:
            wrong.append(f"headers: expected {expected}, got {problems(root)}")
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        (root / "tests").mkdir()
        (root / "tests" / "attacks.md").write_text("| a | `Good.One`, `Bad.One`, `test_good[a]`, `test_bad` |\n", encoding="utf-8")
        (root / "tests" / "test_good.cpp").write_text("TEST_F(Good, One) {}\n", encoding="utf-8")
        (root / "tests" / "check.py").write_text("def test_good(a):\n    pass\n", encoding="utf-8")
        expected = ["tests/attacks.md: there is no test Bad.One", "tests/attacks.md: there is no test test_bad"]
        if problems(root) != expected:
            wrong.append(f"attacks: expected {expected}, got {problems(root)}")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description="Checks the text of the documents.")
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    found = self_test() if arguments.self_test else problems(arguments.root)
    print("\n".join(found) if found else "the documents are in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Counts the string literals of three words or more inside EXPECT_... and ASSERT_... of the tests.

    tests/count_wording.py [ROOT] [--most N] [--list]

Tests should assert codes, places and numbers: a test that repeats the words of a message fails when only the words get
better. The messages themselves are in one golden file. With --most it exits with 1 when there are more than N.
"""

import argparse
import pathlib
import re
import sys

CALL = re.compile(r"\b(?:EXPECT|ASSERT)_\w+\s*\(")
# Raw strings, strings and characters; comments are taken out before.
STRING = re.compile(r'R"(\w*)\((.*?)\)\1"|"((?:[^"\\\n]|\\.)*)"', re.DOTALL)
COMMENT = re.compile(r'("(?:[^"\\\n]|\\.)*")|//[^\n]*|/\*.*?\*/', re.DOTALL)
# Names of files, keys and codes are not words.
WORD = re.compile(r"(?<!\S)(?:[A-Za-z]{2,}|a)[.,;']?(?!\S)")


def arguments_of(text: str, start: int) -> str:
    """What stands between the parenthesis that begins at `start` and its partner; strings do not count."""
    depth, position = 0, start
    while position < len(text):
        string = STRING.match(text, position)
        if string:
            position = string.end()
            continue
        depth += (text[position] == "(") - (text[position] == ")")
        position += 1
        if depth == 0:
            break
    return text[start:position]


def literals(text: str) -> list[str]:
    """The wordings: adjacent literals are one."""
    text = COMMENT.sub(lambda m: m[1] or " ", text)
    found = []
    for call in CALL.finditer(text):
        joined = re.sub(r'"\s*\n\s*"', "", arguments_of(text, call.end() - 1))
        for match in STRING.finditer(joined):
            literal = match[2] if match[2] is not None else match[3]
            if len(WORD.findall(literal)) >= 3:
                found.append(literal)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    parser.add_argument("--most", type=int)
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    total = 0
    for file in sorted((arguments.root / "tests").rglob("*.cpp")):
        wordings = literals(file.read_text(encoding="utf-8"))
        total += len(wordings)
        if wordings and arguments.list:
            print(f"{len(wordings):4} {file.relative_to(arguments.root)}")
    print(f"{total} wordings asserted")
    return 1 if arguments.most is not None and total > arguments.most else 0


if __name__ == "__main__":
    sys.exit(main())

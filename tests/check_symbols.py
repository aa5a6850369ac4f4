#!/usr/bin/env python3
"""Checks what the shared libraries export.

    check_symbols.py --headers include/vantage src/common --internals tests/exported_internals.txt -- LIBRARY...

Every symbol of vantage (text, data and zeroed data; nm -D) must be declared in one of the headers, or be in namespace
vantage::internal and in the list of those that one component needs of another. The list may have at most 59, and all of
them must be exported. With --write the list is written anew. With --self-test the check must notice what is wrong in
examples.
"""

import argparse
import pathlib
import re
import subprocess
import sys

MOST_INTERNALS = 59
SYMBOL = re.compile(r"^[0-9a-f]+ ([TBD]) (.+)$")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def without_arguments(symbol: str) -> str:
    """vantage::A::f(int) const -> vantage::A::f; templates' arguments and [abi:...] go too."""
    name = re.sub(r"\[abi:\w+\]", "", symbol)
    name = name.replace("(anonymous namespace)", "{anonymous}")
    depth, kept = 0, ""
    for character in name:
        if character == "(" and depth == 0:
            break
        depth += (character == "<") - (character == ">")
        if depth == 0 and character != ">":
            kept += character
    words = kept.split(" ")
    return next((word for word in reversed(words) if "vantage::" in word), kept)


def exported(libraries: list[pathlib.Path]) -> set[str]:
    found = set()
    for library in libraries:
        text = subprocess.run(["nm", "-DC", "--defined-only", library], capture_output=True, text=True, check=True).stdout
        for line in text.splitlines():
            match = SYMBOL.match(line)
            if match and "vantage::" in match[2].split("(")[0]:
                found.add(without_arguments(match[2]))
    return found


def problems(symbols: set[str], headers: str, listed: list[str]) -> list[str]:
    declared = set(re.findall(r"~?\b[A-Za-z_]\w*", COMMENT.sub(" ", headers)))
    wrong = []
    internals = {symbol for symbol in symbols if symbol.startswith("vantage::internal::")}
    for symbol in sorted(symbols - internals):
        names = [re.sub(r"^~|\W+$", "", part) for part in symbol.split("::")[1:]]  # destructors, operators
        missing = [name for name in names if name not in declared]
        if missing:
            wrong.append(f"{symbol}: exported, but no header declares {missing[0]}")
    for symbol in sorted(internals - set(listed)):
        wrong.append(f"{symbol}: exported, but not in the list of internals: hide it, or add it with a reason")
    for symbol in sorted(set(listed) - internals):
        wrong.append(f"{symbol}: in the list of internals, but not exported")
    if len(listed) > MOST_INTERNALS:
        wrong.append(f"{len(listed)} internals are exported; at most {MOST_INTERNALS} may be")
    return wrong


def self_test() -> list[str]:
    headers = "namespace vantage { class A { void f(); }; int g(); }  // hidden"
    cases = [
        ({"vantage::A::f", "vantage::g"}, [], ""),
        ({"vantage::A::~A", "vantage::A::operator=="}, [], "no header declares operator"),
        ({"vantage::hidden"}, [], "no header declares hidden"),
        ({"vantage::A::secret"}, [], "no header declares secret"),
        ({"vantage::internal::io::h"}, [], "not in the list"),
        ({"vantage::internal::io::h"}, ["vantage::internal::io::h"], ""),
        (set(), ["vantage::internal::io::h"], "but not exported"),
        ({f"vantage::internal::f{i}" for i in range(60)}, [f"vantage::internal::f{i}" for i in range(60)], "at most 59"),
    ]
    wrong = []
    for symbols, listed, expected in cases:
        found = "\n".join(problems(symbols, headers, listed))
        if (expected not in found) if expected else found:
            wrong.append(f"{symbols}: expected '{expected}', got '{found}'")
    names = {
        "vantage::A::f(std::vector<vantage::B, std::allocator<vantage::B> > const&) const": "vantage::A::f",
        "vantage::internal::core::text[abi:cxx11](unsigned long)": "vantage::internal::core::text",
        "typeinfo for vantage::Error": "vantage::Error",
        "std::vector<int> vantage::internal::f<int>(int)": "vantage::internal::f",
    }
    wrong += [f"{symbol} is read as {without_arguments(symbol)}" for symbol, name in names.items()
              if without_arguments(symbol) != name]
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("libraries", nargs="*", type=pathlib.Path)
    parser.add_argument("--headers", type=pathlib.Path, nargs="+")
    parser.add_argument("--internals", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        wrong = self_test()
        print("\n".join(wrong) if wrong else "the check notices what it should")
        return 1 if wrong else 0
    if not (arguments.libraries and arguments.headers and arguments.internals):
        parser.error("--headers, --internals and the libraries are missing")
    symbols = exported(arguments.libraries)
    if arguments.write:
        internals = sorted(symbol for symbol in symbols if symbol.startswith("vantage::internal::"))
        arguments.internals.write_text("".join(f"{symbol}\n" for symbol in internals), encoding="utf-8")
    listed = arguments.internals.read_text(encoding="utf-8").split()
    headers = "\n".join(header.read_text(encoding="utf-8") for folder in arguments.headers
                        for header in sorted(folder.glob("*.h")))
    wrong = problems(symbols, headers, listed)
    print("\n".join(wrong))
    print(f"{len(symbols)} names exported by {len(arguments.libraries)} libraries, {len(listed)} of them internals")
    return 1 if wrong or not symbols else 0


if __name__ == "__main__":
    sys.exit(main())

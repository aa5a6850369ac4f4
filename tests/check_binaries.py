#!/usr/bin/env python3
"""What was built: no library of the current folder is loaded, and the binaries are hardened as they should be.

    check_binaries.py paths FOLDER...                 where the binaries below these folders look for libraries
    check_binaries.py hardened [--commands FILE] [--compiler CXX] FOLDER...
                                                      how they are hardened, and how each source was compiled
    check_binaries.py loads EXAMPLES PROGRAM          where the program really looks, run in a folder of its own
    check_binaries.py --self-test [--compiler CXX]    each of these finds what is wrong
"""

from __future__ import annotations

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "scripts"))
import read_elf  # noqa: E402

COMPILER = os.environ.get("CXX", "c++")


def binaries(folders: list[pathlib.Path]) -> list[pathlib.Path]:
    """The programs and libraries below these folders; a link stands for the file that it leads to."""
    found = {}
    for folder in folders:
        files = [folder] if folder.is_file() else sorted(folder.rglob("*"))
        for file in files:
            if file.is_file() and file.suffix not in (".o", ".a"):
                found[file.resolve()] = None
    return [file for file in found if read_elf.read(file) is not None]


def faults_of_paths(files: list[pathlib.Path]) -> list[str]:
    return [f"{file} {fault}" for file in files for fault in read_elf.search_path_faults(read_elf.read(file))]


# ---- hardened

# Of the libraries some are small: they call no function that could be fortified.
FORTIFIED = re.compile(r"libvantage\.so.*|_core\..*\.so|vantage|vantage_tests|vantage_bench")
# Of each the last word of a command counts: what it must be, and by what the words on it are known.
FLAGS = (
    ("-fstack-protector-strong", r"-f(no-)?stack-protector\b.*", r"-fstack-protector-(strong|all)"),
    ("-fstack-clash-protection", r"-f(no-)?stack-clash-protection", r"-fstack-clash-protection"),
    ("-D_FORTIFY_SOURCE=2", r"-[DU]_FORTIFY_SOURCE(=.*)?", r"-D_FORTIFY_SOURCE=[23]"),
    ("-D_GLIBCXX_ASSERTIONS", r"-[DU]_GLIBCXX_ASSERTIONS(=.*)?", r"-D_GLIBCXX_ASSERTIONS(=.*)?"),
)
MAY_LACK = (  # flags that not every processor has
    ("-fcf-protection", r"-fcf-protection\b.*", r"-fcf-protection(=full)?"),
    ("-fPIE", r"-f(no-)?(pie|PIE|pic|PIC)", r"-f(pie|PIE|pic|PIC)"),
)
ENGINE = re.compile(r"_hot_objects\.dir/")  # VANTAGE_HOT_OPTIONS in cmake/Options.cmake: it alone may lack assertions


def faults_of_hardening(files: list[pathlib.Path], features: int) -> list[str]:
    found = []
    for file in files:
        elf = read_elf.read(file)
        found += [f"{file} {fault}" for fault in read_elf.hardening_faults(elf, FORTIFIED.fullmatch(file.name) is not None)]
        if features & ~elf.x86_features:
            found.append(f"{file} is not marked as one that keeps to IBT and SHSTK")
    return found


def features_of_start_files(compiler: str) -> int:
    """IBT and SHSTK, where all that the system links into each binary keeps to them: a binary is marked only then. The
    start files of Debian 12 are not marked."""
    found = read_elf.IBT | read_elf.SHSTK
    for name in ("crti.o", "crtn.o", "crtbeginS.o", "Scrt1.o"):
        told = subprocess.run([compiler, f"-print-file-name={name}"], capture_output=True, text=True, check=True).stdout.strip()
        file = pathlib.Path(told)
        elf = read_elf.read(file) if file.is_absolute() else None
        found &= elf.x86_features if elf else 0
    return found


def faults_of_commands(commands: pathlib.Path) -> list[str]:
    """Sources, third-party ones too, that are compiled without a flag, or with one that takes it back."""
    found = []
    for entry in json.loads(commands.read_text(encoding="utf-8")):
        words = [part for word in shlex.split(re.sub(r"(?<=\s)-([DU])\s+", r"-\1", entry["command"]))
                 for part in (word[4:].split(",") if word.startswith("-Wp,") else [word])]
        for flag, known, right in FLAGS + MAY_LACK:
            last = [word for word in words if re.fullmatch(known, word)][-1:]
            if not last and (flag, known, right) in FLAGS:
                found.append(f"{entry['file']} is compiled without {flag}")
            elif last and not re.fullmatch(right, last[0]):
                if last[0] == "-U_GLIBCXX_ASSERTIONS" and ENGINE.search(entry["command"]):
                    continue
                found.append(f"{entry['file']} is compiled with {last[0]} as the last word on {flag}")
    return found


# ---- loads

RASTER = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n3 4\n"
RUNS = (  # what is loaded at run time, and what loads it
    ("libproj.so", ["inspect", "{examples}/town/town.osm"]),
    ("libgdal.so", ["inspect", "{folder}/heights.asc"]),
    ("libEGL.so", ["devices"]),
)


def tried_files(command: list[str], folder: pathlib.Path) -> list[str]:
    """Each file that the loader of the C library tried to open as a library."""
    logs = folder / "logs"
    logs.mkdir(exist_ok=True)
    for old in logs.iterdir():
        old.unlink()
    environment = {key: value for key, value in os.environ.items() if not key.startswith("LD_")}
    subprocess.run(command, cwd=folder, env={**environment, "LD_DEBUG": "libs", "LD_DEBUG_OUTPUT": str(logs / "log")},
                   stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    text = "".join(log.read_text(errors="replace") for log in logs.iterdir())
    return re.findall(r"trying file=(\S*)", text)


def faults_of_loading(command: list[str], examples: pathlib.Path) -> list[str]:
    found = []
    command = [str(pathlib.Path(command[0]).resolve()) if "/" in command[0] else command[0], *command[1:]]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "heights.asc").write_text(RASTER, encoding="utf-8")
        for library, arguments in RUNS:
            words = [word.format(examples=examples.resolve(), folder=folder) for word in arguments]
            tried = tried_files([*command, *words], folder)
            if not any(library in file for file in tried):
                found.append(f"{' '.join(words)}: {library} was not looked for, so that nothing was learnt")
            for file in tried:
                if not file.startswith("/") or file.startswith(str(folder)):
                    found.append(f"{' '.join(words)}: {file!r} was looked for in the current folder")
    return found


# ---- the checks find what is wrong

class Checks(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name).resolve()

    GOOD = ("-O2 -fPIC -fstack-protector-strong -fcf-protection -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 "
            "-Wl,-z,relro,-z,now,-z,noexecstack")
    CODE = ('#include <cstring>\n__attribute__((visibility("default"))) int shown(const char* text, int n) {\n'
            "  char buffer[64];\n  std::memcpy(buffer, text, n);\n  return buffer[3];\n}\n")
    MAIN = "int main(int count, char** words) { return shown(words[0], count); }\n"

    def make(self, name: str, flags: str, code: str | None = None) -> pathlib.Path:
        file = self.scratch / name
        file.parent.mkdir(exist_ok=True)
        subprocess.run([COMPILER, "-x", "c++", "-", "-x", "none", "-o", str(file), *shlex.split(flags)], input=code or self.CODE, text=True,
                       check=True)
        return file

    def test_paths(self):
        for given, fault in (("$ORIGIN", None), ("$ORIGIN/../lib:/usr/lib", None), ("${ORIGIN}/x", None),
                             ("/usr/lib:", "an empty entry"), ("::", "an empty entry"), ("lib", "relative"),
                             ("./lib:$ORIGIN", "relative"), ("$ORIGINAL/lib", "relative"),
                             ("/tmp/vantage/lib", "everybody may write")):
            for tags in ("--enable-new-dtags", "--disable-new-dtags"):
                library = self.make("one.so", f"-shared -fPIC -Wl,{tags} '-Wl,-rpath,{given}'")
                found = faults_of_paths(binaries([self.scratch]))
                self.assertEqual(bool(found), fault is not None, f"{given}: {found}")
                self.assertIn(fault or "", "".join(found))
                self.assertEqual(read_elf.read(library).search_path, given.split(":"))
        self.assertEqual(faults_of_paths(binaries([self.make("none.so", "-shared -fPIC")])), [])
        own = self.make("a/own.so", "-shared -fPIC")
        asks = self.make("asks.so", f"-shared -fPIC -Wl,--no-as-needed {os.path.relpath(own)}")
        self.assertIn("which is relative to the current folder", "".join(faults_of_paths([asks])))

    def faults(self, flags: str, code: str | None = None) -> str:
        return "\n".join(read_elf.hardening_faults(read_elf.read(self.make("one", flags, code)), True))

    def test_hardened(self):
        program = self.CODE + self.MAIN
        self.assertEqual(self.faults(f"{self.GOOD} -shared"), "")
        self.assertEqual(self.faults(f"{self.GOOD} -pie", program), "")
        for bad, fault in (("-fno-stack-protector", "__stack_chk_fail"), ("-U_FORTIFY_SOURCE", "__memcpy_chk"),
                           ("-Wl,-z,lazy", "BIND_NOW"), ("-Wl,-z,norelro", "GNU_RELRO"), ("-Wl,-z,execstack", "GNU_STACK"),
                           ("-fcf-protection=none", "endbr64")):
            if fault == "endbr64" and os.uname().machine != "x86_64":
                continue
            for more, code in (("-shared", self.CODE), ("-pie", program)):
                self.assertIn(fault, self.faults(f"{self.GOOD} {bad} {more}", code), bad)
        self.assertIn("no PIE", self.faults(f"{self.GOOD} -no-pie -fno-pic -fno-pie", program))

    def test_stripped_and_static_programs(self):
        program = self.CODE + self.MAIN.replace("int main", '__attribute__((visibility("hidden"))) int main')
        stripped = f"{self.GOOD} -fvisibility=hidden -pie -s"
        hidden = program.replace('visibility("default")', 'visibility("hidden")')
        self.assertEqual(self.faults(stripped, hidden), "")
        self.assertIn("__stack_chk_fail", self.faults(f"{stripped} -fno-stack-protector", hidden))
        static = read_elf.read(self.make("static", f"{self.GOOD} -static-pie -s -Wl,-z,stack-size=8388608", program))
        self.assertTrue(static.is_program and static.may_lie_anywhere and static.has_stack_protector)
        self.assertFalse(static.has_loader or static.needed)
        self.assertEqual(static.stack_bytes, 8388608)
        self.assertEqual(read_elf.hardening_faults(static, False), [])
        fixed = read_elf.read(self.make("fixed", f"{self.GOOD} -static -no-pie -fno-pie", program))
        self.assertTrue(fixed.is_program and not fixed.has_loader)

    def test_the_versions_are_read(self):
        library = self.make("one.so", f"{self.GOOD} -shared")
        told = subprocess.run(["readelf", "--version-info", "--wide", str(library)], capture_output=True, text=True, check=True)
        needed = told.stdout.partition("Version needs")[2]
        self.assertEqual(read_elf.read(library).needed_versions, set(re.findall(r"Name: (\S+)", needed)))
        self.assertEqual(read_elf.read(self.make("none.so", "-shared -nostdlib", "int nothing;")).needed_versions, set())

    def test_the_property_is_read(self):
        for flags, found in (("-fcf-protection=full", read_elf.IBT | read_elf.SHSTK), ("-fcf-protection=branch", read_elf.IBT),
                             ("-fcf-protection=return", read_elf.SHSTK), ("-fcf-protection=none", 0)):
            if os.uname().machine == "x86_64":
                self.assertEqual(read_elf.read(self.make("a.o", f"-c {flags}")).x86_features, found, flags)

    def test_commands(self):
        good = f"c++ {' '.join(flag for flag, _, _ in FLAGS)} -c"
        file = self.scratch / "commands.json"

        def faults(command: str) -> list[str]:
            file.write_text(json.dumps([{"file": "a.cpp", "command": command}]))
            return faults_of_commands(file)

        for bad in ("-fno-stack-protector", "-fstack-protector", "-U_FORTIFY_SOURCE", "-U _FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=0",
                    "-D_FORTIFY_SOURCE=1", "-D_FORTIFY_SOURCE", "-Wp,-U_FORTIFY_SOURCE", "-U_GLIBCXX_ASSERTIONS",
                    "-fcf-protection=none", "-fcf-protection=branch", "-fno-stack-clash-protection", "-fno-pie", "-fno-PIC"):
            self.assertEqual(len(faults(f"{good} {bad} a.cpp")), 1, bad)
            self.assertIn(bad.split(",")[-1].replace(" ", ""), faults(f"{good} {bad} a.cpp")[0])
            again = f"{good} {bad} {' '.join(flag for flag, _, _ in FLAGS + MAY_LACK)} a.cpp"
            self.assertEqual(faults(again), [], f"{bad}, and then what is right")
        for fine in ("", "-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3", "-D _FORTIFY_SOURCE=3", "-Wp,-D_FORTIFY_SOURCE=2",
                     "-fcf-protection", "-fPIC", "-D_GLIBCXX_ASSERTIONS=1",
                     "-U_GLIBCXX_ASSERTIONS -o CMakeFiles/vantage_core_hot_objects.dir/a.o"):
            self.assertEqual(faults(f"{good} {fine} a.cpp"), [], fine)
        self.assertEqual(len(faults(f"{good} -U_FORTIFY_SOURCE -o CMakeFiles/vantage_core_hot_objects.dir/a.o a.cpp")), 1)
        file.write_text(json.dumps([{"file": "a.cpp", "command": "c++ -c a.cpp"}]))
        self.assertEqual(len(faults_of_commands(file)), len(FLAGS))

    def test_loads(self):
        """A program that opens what its arguments make it open, with and without the current folder in its path."""
        code = ('#include <dlfcn.h>\n#include <cstring>\nint main(int count, char** words) {\n'
                '  const bool is_raster = count > 2 && std::strstr(words[2], ".asc") != nullptr;\n'
                '  dlopen(count == 2 ? "libEGL.so.none" : is_raster ? "libgdal.so.none" : "libproj.so.none", RTLD_LAZY);\n'
                "}\n")
        for given, faults in (("$ORIGIN", 0), ("$ORIGIN:", 3), ("lib", 3)):
            program = self.make("program", f"'-Wl,-rpath,{given}' -ldl", code)
            found = faults_of_loading([str(program)], self.scratch)
            self.assertEqual(bool(found), bool(faults), found)
        nothing = self.make("nothing", "", "int main() {}\n")
        self.assertEqual(sum("nothing was learnt" in fault for fault in faults_of_loading([str(nothing)], self.scratch)), 3)


def tell(found: list[str], checked: str) -> int:
    for fault in found[:40]:
        print(fault)
    if found:
        print(f"binaries: {len(found)} faults. A file that an earlier configuration built stays until it is built again")
        return 1
    print(f"binaries: {checked} in order")
    return 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("paths", "hardened"):
        command = commands.add_parser(name)
        command.add_argument("folders", nargs="+", type=pathlib.Path)
        if name == "hardened":
            command.add_argument("--commands", type=pathlib.Path)
            command.add_argument("--compiler", default=COMPILER)
    loads = commands.add_parser("loads")
    loads.add_argument("examples", type=pathlib.Path)
    loads.add_argument("program", nargs="+")
    arguments = parser.parse_args()
    if arguments.command == "loads":
        return tell(faults_of_loading(arguments.program, arguments.examples), f"{len(RUNS)} runs")
    files = binaries([folder for folder in arguments.folders if folder.exists()])
    if not files:
        print("binaries: there are none")
        return 1
    if arguments.command == "paths":
        return tell(faults_of_paths(files), f"{len(files)} files")
    features = features_of_start_files(arguments.compiler)
    found = faults_of_hardening(files, features)
    if arguments.commands:
        found += faults_of_commands(arguments.commands)
    return tell(found, f"{len(files)} files{'' if features else ' (IBT and SHSTK: the system marks none)'}")


if __name__ == "__main__":
    if "--self-test" in sys.argv:
        words = [word for word in sys.argv[1:] if word != "--self-test"]
        if words[:1] == ["--compiler"]:
            COMPILER = words[1]
        unittest.main(argv=sys.argv[:1])
    sys.exit(main())

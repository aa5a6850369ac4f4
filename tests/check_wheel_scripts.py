#!/usr/bin/env python3
"""Tests of the scripts that make and check wheels: what must fail fails."""

import hashlib
import importlib.util
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest
import zipfile

from script_test import ROOT, ScriptTest


class WheelScripts(ScriptTest):
    LICENCES = "vantage-1.dist-info/licenses/"

    def wheel(self, changes: dict[str, bytes | str | None]) -> pathlib.Path:
        """A wheel whose list is right, but for `changes`: files to add, to replace, or (None) to take away."""
        library = self.scratch / "plain.so"
        subprocess.run(["gcc", "-shared", "-nostdlib", "-x", "c", "-", "-o", str(library)], input=b"int PyInit__core;", check=True)
        files: dict[str, bytes | str | None] = {
            "vantage/__init__.py": "", "vantage/_core.cpython-311-x86_64-linux-gnu.so": library.read_bytes(),
            self.LICENCES + "LICENSE": "ours", self.LICENCES + "THIRD-PARTY-NOTICES.txt": "notices",
            self.LICENCES + "third-party/LIBRARIES.txt": "# name\nzlib | Zlib | zlib.txt | Debian\n",
            self.LICENCES + "third-party/zlib.txt": "the licence of zlib"}
        files |= changes
        file = self.scratch / "vantage-1-cp311-cp311-linux_x86_64.whl"
        with zipfile.ZipFile(file, "w") as archive:
            for name, content in files.items():
                if content is not None:
                    archive.writestr(name, content)
        return file

    def expect_wheel(self, code: int, words: str, changes: dict[str, bytes | str | None]) -> None:
        file = self.wheel(changes)
        found, text = self.run_script("wheel_licences.py", "check", str(file))
        self.assertEqual(found, code, text)
        self.assertIn(words, text)

    def test_wheel_has_nothing_but_what_is_listed(self):
        third_party = self.LICENCES + "third-party/"
        self.expect_wheel(0, "all that is in it is listed", {})
        self.expect_wheel(1, "vantage.libs/libjbig-1a2b.so.0 is a binary that is not listed",
                          {"vantage.libs/libjbig-1a2b.so.0": b"\x7fELF"})
        self.expect_wheel(1, "jbigkit (GPL-2) is not in scripts/wheel_libraries.toml",
                          {third_party + "LIBRARIES.txt": "jbigkit | GPL-2 | zlib.txt | Debian\n"})
        self.expect_wheel(1, "zlib (GPL-3) is not in scripts/wheel_libraries.toml",
                          {third_party + "LIBRARIES.txt": "zlib | GPL-3 | zlib.txt | Debian\n"})
        self.expect_wheel(1, "zlib is under LGPL-2.1 alone",
                          {third_party + "LIBRARIES.txt": "zlib | LGPL-2.1 | zlib.txt | Debian\n"})
        self.expect_wheel(1, "the licence of zlib is missing", {third_party + "zlib.txt": None})
        self.expect_wheel(1, "it has no LIBRARIES.txt", {third_party + "LIBRARIES.txt": None})
        self.expect_wheel(1, "THIRD-PARTY-NOTICES.txt is missing", {self.LICENCES + "THIRD-PARTY-NOTICES.txt": None})

    def test_wheel_loads_only_what_every_system_has(self):
        other, library = self.scratch / "libX11.so.6", self.scratch / "loads.so"
        subprocess.run(["gcc", "-shared", "-nostdlib", "-Wl,-soname,libX11.so.6", "-x", "c", "-", "-o", str(other)],
                       input=b"int b;", check=True)
        subprocess.run(["gcc", "-shared", "-nostdlib", "-Wl,--no-as-needed", "-o", str(library), str(other)], check=True)
        self.expect_wheel(1, "loads libX11.so.6, which is not part of every system",
                          {"vantage/_core.cpython-311-x86_64-linux-gnu.so": library.read_bytes()})

    def test_wheel_shows_nothing_to_other_modules(self):
        library = self.scratch / "shows.so"
        subprocess.run(["gcc", "-shared", "-nostdlib", "-x", "c", "-", "-o", str(library)],
                       input=b"int PyInit__core, proj_create;", check=True)
        self.expect_wheel(1, "shows proj_create to other modules",
                          {"vantage/_core.cpython-311-x86_64-linux-gnu.so": library.read_bytes()})

    def licences(self):
        """scripts/wheel_licences.py as a module."""
        sys.path.insert(0, str(self.tree / "scripts"))
        self.addCleanup(sys.path.remove, str(self.tree / "scripts"))
        spec = importlib.util.spec_from_file_location("wheel_licences", self.tree / "scripts" / "wheel_licences.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    def test_wheel_has_nothing_under_the_gpl_alone(self):
        module = self.licences()
        for licence in ("GPL-2", "LGPL-2.1", "AGPL-3", "MIT; parts LGPL-2.1", "GPL-3 with an exception"):
            self.assertTrue(module.is_copyleft(licence), licence)
        for licence in ("MIT", "MPL-1.1 (chosen; or LGPL-2.1)", "FTL (chosen; or GPL-2)"):
            self.assertFalse(module.is_copyleft(licence), licence)
        for entry in module.entries(module.read_list()):
            self.assertFalse(module.is_copyleft(entry["licence"]), entry)

    def test_wheel_names_what_was_linked_and_compiled(self):
        module = self.licences()
        listed = module.read_list()
        build = self.scratch / "build"
        build.mkdir()

        def archives(command: str) -> set[str]:
            """Those of a build whose module is made by that command."""
            (build / "build.ninja").write_text(f"rule link\n  command = {command}\nbuild _core.so: link\n"
                                               "build vantage_python: phony _core.so\n", encoding="utf-8")
            return module.given_archives(build)

        given = archives("c++ -o _core.so a.o /usr/lib/libcairo.a lib/libvantage.a libjbig.a -lm")
        self.assertEqual(given, {"libcairo.a", "libvantage.a", "libjbig.a"})
        self.assertEqual(module.unknown_archives(given, listed), (["libjbig.a"], {"Cairo"}))
        with self.assertRaises(module.Failure):
            archives("c++ -o _core.so a.o -lm")
        strange, used = module.unknown_headers(
            {pathlib.Path("/usr/include/stdio.h"), pathlib.Path("/opt/gpl/a.h"), pathlib.Path("/deps/cdt/CDT.h")},
            {pathlib.Path("/deps/cdt"): "CDT"}, listed)
        self.assertEqual((strange, used), (["/opt/gpl/a.h (of no Debian package)"], {"CDT"}))

    def test_portable_wheel_is_named_by_what_it_needs(self):
        sys.path.insert(0, str(ROOT / "scripts"))
        self.addCleanup(sys.path.remove, str(ROOT / "scripts"))
        portable = importlib.import_module("build_portable_wheels")
        folder, dist = self.scratch / "wheel", self.scratch / "dist"
        module, info = folder / "vantage" / "_core.abi3.so", folder / "vantage-1.dist-info"
        for made in (module.parent, info, dist):
            made.mkdir(parents=True)

        def pack(symbol: str, version: str, target: str) -> list[str]:
            """The names of the wheels there are after packing a module that takes one function from glibc."""
            stub = self.scratch / "libc.so.6"
            link = ["gcc", "-shared", "-fPIC", "-nostdlib", "-Wl,--no-as-needed", "-x", "c", "-"]
            (self.scratch / "map").write_text(f"GLIBC_{version} {{ global: {symbol}; }};\n", encoding="utf-8")
            subprocess.run([*link, "-Wl,-soname,libc.so.6", f"-Wl,--version-script={self.scratch / 'map'}", "-o", str(stub)],
                           input=f"void {symbol}(void) {{}}", text=True, check=True)
            subprocess.run([*link, "-o", str(module), "-x", "none", str(stub)], text=True, check=True,
                           input=f"void {symbol}(void); void PyInit__core(void) {{ {symbol}(); }}")
            portable.pack(folder, "cp312-abi3", target, dist)
            return [file.name for file in dist.glob("*.whl")]

        self.assertEqual(pack("older", "2.4", "x86_64-linux-gnu.2.17"), ["vantage-1-cp312-abi3-manylinux_2_17_x86_64.manylinux2014_x86_64.whl"])
        self.assertEqual(pack("newer", "2.28", "x86_64-linux-gnu.2.28"), ["vantage-1-cp312-abi3-manylinux_2_28_x86_64.whl"])
        with zipfile.ZipFile(next(dist.iterdir())) as archive:
            self.assertIn("Tag: cp312-abi3-manylinux_2_28_x86_64\n", archive.read("vantage-1.dist-info/WHEEL").decode())
            rows = [line.split(",") for line in archive.read("vantage-1.dist-info/RECORD").decode().split()]
            self.assertEqual({row[0] for row in rows}, set(archive.namelist()))
        for target in ("x86_64-linux-gnu.2.17", "x86_64-linux-gnu"):  # its glibc is older, or not known
            with self.assertRaises(portable.Failure):
                pack("newer", "2.28", target)
        self.assertEqual([file.name for file in dist.iterdir()], ["vantage-1-cp312-abi3-manylinux_2_28_x86_64.whl"])

    def foreign_binary(self, kind: str, library: str) -> bytes:
        """What loads one library, and does nothing: of Windows (PE32+) or macOS (Mach-O)."""
        name = library.encode() + b"\0"
        if kind == "macos":
            size = (24 + len(name) + 7) // 8 * 8
            load = struct.pack("<6I", 0xC, size, 24, 0, 0, 0) + name.ljust(size - 24, b"\0")
            build = struct.pack("<6I", 0x32, 24, 1, 11 << 16, 11 << 16, 0)
            return b"\xcf\xfa\xed\xfe" + struct.pack("<7I", 0x100000C, 0, 6, 2, len(load + build), 0, 0) + load + build
        data = bytearray(0x400)
        data[:2], data[0x80:0x84] = b"MZ", b"PE\0\0"
        struct.pack_into("<I", data, 0x3C, 0x80)
        struct.pack_into("<HH", data, 0x84, 0x8664, 1)
        struct.pack_into("<H", data, 0x80 + 20, 240)  # the size of the optional header
        struct.pack_into("<H", data, 0x98, 0x20B)
        struct.pack_into("<II", data, 0x98 + 120, 0x1000, 40)  # imports
        struct.pack_into("<4I", data, 0x98 + 240 + 8, 0x200, 0x1000, 0x200, 0x200)  # the only section
        struct.pack_into("<5I", data, 0x200, 0, 0, 0, 0x1000 + 40, 0)
        data[0x228:0x228 + len(name)] = name
        return bytes(data)

    def test_wheel_for_other_systems_loads_only_what_these_have(self):
        for kind, module, known in (("windows", "_core.pyd", "KERNEL32.dll"), ("macos", "_core.abi3.so", "/usr/lib/libSystem.B.dylib")):
            name, none = f"vantage/{module}", {"vantage/_core.cpython-311-x86_64-linux-gnu.so": None}
            self.expect_wheel(0, "all that is in it is listed", {**none, name: self.foreign_binary(kind, known)})
            self.expect_wheel(1, "loads libstdc++-6.dll", {**none, name: self.foreign_binary(kind, "libstdc++-6.dll")})
            self.expect_wheel(1, "other.dll is a binary", {**none, "vantage/other.dll": self.foreign_binary(kind, known)})

    def test_mathematics_that_are_not_of_glibc_are_found(self):
        sys.path.insert(0, str(ROOT / "scripts"))
        self.addCleanup(sys.path.remove, str(ROOT / "scripts"))
        read_elf = importlib.import_module("read_elf")
        module = self.scratch / "_core.abi3.so"

        def faults(source: str) -> list[str]:
            text = f"#include <math.h>\ndouble f(double x) {{ return sin(x) + cos(x) + tan(x) + exp(x) + log(x); }}\n{source}"
            subprocess.run(["gcc", "-shared", "-fPIC", "-fno-builtin", "-x", "c", "-", "-o", str(module), "-lm"], input=text, text=True,
                           check=True)
            return read_elf.mathematics_faults(read_elf.read(module))

        self.assertEqual(faults(""), [])
        found = faults('__attribute__((visibility("hidden"))) double cos(double x) { return x; }')
        self.assertEqual([("cos" in fault, "sin" in fault) for fault in found], [(True, False)])

    def test_runtime_of_zig_computes_as_the_compiler_does(self):
        source = self.scratch / "compare.c"
        names = ("__udivti3", "__divti3", "__muldc3", "__divdc3")
        source.write_text("#include <complex.h>\n#include <stdio.h>\n" + "".join(f"#define {name} our{name}\n" for name in names) +
                          f'#include "{ROOT / "cmake" / "zig_runtime.c"}"\n' + r"""
static unsigned long long state = 88172645463325252ull;
static unsigned long long drawn(void) {
  state ^= state << 13, state ^= state >> 7;
  return state ^= state << 17;
}
static u128 wide(void) { return ((u128)drawn() << 64 | drawn()) >> drawn() % 128; }
static double number(void) { return scalbn((double)(long long)drawn(), (int)(drawn() % 200) - 160); }
int main(void) {
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const u128 a = wide(), b = wide() | 1;
    const __int128 c = drawn() & 1 ? -a : a, d = (drawn() & 1 ? -(b >> 1) : b >> 1) | 2;
    wrong += our__udivti3(a, b) != a / b || our__divti3(c, d) != c / d;
    const double p = number(), q = number(), r = number(), s = number();
    const complex_double product = CMPLX(p, q) * CMPLX(r, s), quotient = CMPLX(p, q) / CMPLX(r, s);
    wrong += our__muldc3(p, q, r, s) != product || cabs(our__divdc3(p, q, r, s) - quotient) > 1e-15 * cabs(quotient);
  }
  const complex_double over = our__muldc3(INFINITY, NAN, 1, 1), by_zero = our__divdc3(1, 1, 0, 0), none = our__divdc3(1, 2, INFINITY, 1);
  wrong += !isinf(creal(over)) || !isinf(creal(by_zero)) || none != 0;
  printf("%d wrong", wrong);
}
""", encoding="utf-8")
        program = self.scratch / "compare"
        subprocess.run(["gcc", "-O1", "-w", "-ffp-contract=off", str(source), "-o", str(program), "-lm"], check=True)
        self.assertEqual(subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout, "0 wrong")

    def test_hypotenuse_of_zig_is_the_nearest_number(self):
        source = self.scratch / "compare.c"
        source.write_text(f'#include <math.h>\n#include <stdio.h>\n#define hypot our_hypot\n#include "{ROOT / "cmake" / "zig_hypot.c"}"\n' + r"""
static unsigned long long state = 88172645463325252ull;
static unsigned long long drawn(void) {
  state ^= state << 13, state ^= state >> 7;
  return state ^= state << 17;
}
int main(void) {
  int wrong = 0;
  for (int i = 0; i < 100000; ++i) {
    const double a = ldexp(1 + 0x1p-52 * (double)(drawn() >> 12), (int)(drawn() % 1900) - 950);
    const double of_a[] = {1, 1 + 0x1p-52, 0.5 + 0x1p-54 * (double)(drawn() >> 11), ldexp(0.7, -(int)(drawn() % 90))};
    const double b = a * of_a[drawn() % 4];
    const long double right = sqrtl((long double)a * a + (long double)b * b), place = ldexpl(1, ilogbl(right) - 52);
    wrong += fabsl(our_hypot(a, -b) - right) > 0.501L * place || our_hypot(a, b) != our_hypot(-b, a);
  }
  wrong += our_hypot(INFINITY, NAN) != INFINITY || !isnan(our_hypot(NAN, 1)) || our_hypot(-0.0, 0) != 0;
  wrong += our_hypot(1e308, 1.7e308) != INFINITY || our_hypot(3 * 0x1p-1074, 4 * 0x1p-1074) != 5 * 0x1p-1074;
  wrong += our_hypot(1e-200, -1e150) != 1e150 || our_hypot(0x3p+900, 0x4p+900) != 0x5p+900;
  printf("%d wrong", wrong);
}
""", encoding="utf-8")
        program = self.scratch / "compare"
        subprocess.run(["gcc", "-O1", "-w", "-ffp-contract=off", str(source), "-o", str(program), "-lm"], check=True)
        self.assertEqual(subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout, "0 wrong")

    def test_what_was_linked_before_the_runtime_is_linked_again(self):
        sys.path.insert(0, str(self.tree / "scripts"))
        self.addCleanup(sys.path.remove, str(self.tree / "scripts"))
        spec = importlib.util.spec_from_file_location("build_wheel_libraries", self.tree / "scripts" / "build_wheel_libraries.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module  # dataclasses look there
        self.addCleanup(sys.modules.pop, spec.name)
        spec.loader.exec_module(module)
        files = [self.scratch / name for name in ("older.so", "libvantage_zig.a", "newer.so")]
        for seconds, file in enumerate(files):
            file.touch()
            os.utime(file, (seconds, seconds))
        tools = module.Tools(str(self.scratch / "clang"), "", "", "", [], [], "x86_64")
        module.unlink_older(tools, [files[0], files[2], self.scratch / "none.so"])
        self.assertEqual([file.exists() for file in files], [False, True, True])

    def test_no_wheel_to_try_is_a_failure(self):
        shutil.copy(ROOT / "Makefile", self.tree)
        tried = self.scratch / "tried"
        (self.tree / "scripts" / "check_wheel.sh").write_text(f"#!/bin/sh\necho $1 >> {tried}\n", encoding="utf-8")
        dist = self.tree / "dist"
        dist.mkdir()
        make = ["make", "--no-print-directory", "-o", "build", "check_wheels"]

        def is_right(*variables: str) -> bool:
            return subprocess.run([*make, *variables], cwd=self.tree, env=self.environment, capture_output=True,
                                  check=False).returncode == 0

        self.assertFalse(is_right("PROCESSORS=x86_64"))
        (dist / "vantage-1-py3-none-any.whl").touch()  # that of `make wheelwasm`
        self.assertFalse(is_right("PROCESSORS=x86_64"))
        self.assertFalse(tried.exists())
        wheel = "dist/vantage-1-cp312-abi3-manylinux_2_17_x86_64.manylinux2014_x86_64.whl"
        (self.tree / wheel).touch()
        self.assertTrue(is_right("PROCESSORS=x86_64"))
        self.assertEqual(tried.read_text(), f"{wheel}\n")
        self.assertFalse(is_right("PROCESSORS=x86_64 aarch64"), "there is none for aarch64")

    def test_cesium_is_not_tried_in_a_node_that_reads_empty_files(self):
        script = ROOT / "integrations" / "cesium" / "check_czml.sh"
        self.put_tool("node", "echo v18.20.4\n")
        result = subprocess.run([str(script), str(self.scratch / "work")], env={**self.environment, "VANTAGE": "/bin/true"},
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertEqual((result.stderr.count("\n"), "v18.20.4" in result.stderr), (1, True), result.stderr)
        self.assertFalse((self.scratch / "work").exists())

    def test_wheel_libraries_are_those_that_are_pinned(self):
        archive = self.archive("thing-1", ["thing.c", "LICENSE"])
        pool = self.scratch / "pool"
        (pool / "p").mkdir(parents=True)
        (pool / "p" / "thing.tar.gz").write_bytes(archive)
        self.put_tool("apt-get", f"echo 'Debian stable file://{pool}/'\n")
        (self.tree / "scripts" / "zig_compiler.sh").write_text("#!/bin/sh\necho /usr/bin\n", encoding="utf-8")
        listing = self.scratch / "list.toml"

        def build(sha256: str) -> tuple[int, str]:
            listing.write_text(
                f'[portable]\ncompiler = "-fPIC"\nx86_64 = ""\n[[built]]\nname = "thing"\nversion = "1"\nlicence = "MIT"\nsource = "p/thing.tar.gz"\n'
                f'sha256 = "{sha256}"\ntexts = ["LICENSE"]\nbuild = "sources"\nlibrary = "thing"\nsources = []\n'
                'includes = { "." = ["thing.c"] }\n', encoding="utf-8")
            return self.run_script("build_wheel_libraries.py", "--list", str(listing), "--folder", str(self.scratch / "built"),
                                   "--target", "x86_64-linux-gnu.2.17")

        code, text = build("0" * 64)
        self.assertEqual(code, 1)
        self.assertIn("the archive has no p/thing.tar.gz with the hash of the list (its hash differs)", text)
        code, text = build(hashlib.sha256(archive).hexdigest())
        self.assertEqual(code, 0, text)
        self.assertEqual((self.scratch / "built" / "prefix" / "licences" / "thing.txt").read_text(), "LICENSE")
        shutil.rmtree(pool)
        self.assertEqual(build(hashlib.sha256(archive).hexdigest()), (0, ""), "what is built is not fetched again")


if __name__ == "__main__":
    unittest.main()

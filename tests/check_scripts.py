#!/usr/bin/env python3
"""Tests of scripts/: what must fail fails, and what it leaves behind.

    check_scripts.py [ROOT]
"""

import ast
import contextlib
import functools
import hashlib
import http.server
import importlib.util
import io
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tarfile
import tempfile
import threading
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Scripts(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name).resolve()
        self.tree = self.scratch / "tree"
        shutil.copytree(ROOT / "scripts", self.tree / "scripts")
        # Neither a repository above the scratch folder nor a proxy may take part.
        self.environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(self.scratch), "no_proxy": "*"}

    def run_script(self, script: str, *arguments: str, cwd: pathlib.Path | None = None) -> tuple[int, str]:
        here = cwd or self.tree
        result = subprocess.run([str(here / "scripts" / script), *arguments], cwd=here, env=self.environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return result.returncode, result.stdout

    def git(self, *arguments: str) -> None:
        subprocess.run(["git", "-C", str(self.tree), *arguments], check=True, capture_output=True)

    def put_tool(self, name: str, text: str) -> None:
        """A program that takes the place of another one."""
        tool = self.scratch / "tools" / name
        tool.parent.mkdir(exist_ok=True)
        tool.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        tool.chmod(0o755)
        self.environment["PATH"] = f"{tool.parent}:{os.environ['PATH']}"

    # ---- format.sh

    def test_format_fails_where_git_does(self):
        code, text = self.run_script("format.sh", "--check")
        self.assertNotEqual(code, 0, text)
        self.assertNotIn("in order", text)

    def test_format_fails_without_sources(self):
        self.git("init")
        self.assertEqual(self.run_script("format.sh", "--check"), (1, "format: no sources found\n"))

    def test_format_names_what_is_not_formatted(self):
        self.git("init")
        for name in ("good.cpp", "bad.cpp"):
            (self.tree / name).write_text("int x;\n", encoding="utf-8")
        self.put_tool("clang-format", 'case "$*" in *bad.cpp) exit 1;; esac\n')
        code, text = self.run_script("format.sh", "--check")
        self.assertEqual(code, 1)
        self.assertIn("bad.cpp\nformat: 1 files are not formatted", text)
        (self.tree / "bad.cpp").unlink()
        self.assertEqual(self.run_script("format.sh", "--check"), (0, "format: 1 files in order\n"))

    # ---- lint.sh

    def prepare_lint(self, compiled: pathlib.Path) -> None:
        (self.tree / "src" / "room").mkdir(parents=True)
        (self.tree / "src" / "room" / "a.cpp").write_text("int a;\n", encoding="utf-8")
        (self.tree / "build").mkdir()
        (self.tree / "build" / "compile_commands.json").write_text(
            json.dumps([{"directory": str(self.tree), "command": f"/usr/bin/c++ -DX -c {compiled}", "file": str(compiled)}], indent=2), encoding="utf-8")
        self.git("init")
        self.git("add", "src")
        self.put_tool("clang-tidy", 'echo "checked $*"\n')

    def test_lint_fails_when_nothing_matches(self):
        self.prepare_lint(self.scratch / "elsewhere" / "src" / "room" / "a.cpp")
        code, text = self.run_script("lint.sh")
        self.assertEqual(code, 1)
        self.assertIn("none of the files is among the 1 that", text)

    def test_lint_finds_its_files_through_a_symbolic_link(self):
        file = self.tree / "src" / "room" / "a.cpp"
        self.prepare_lint(file)
        link = self.scratch / "link"
        link.symlink_to(self.tree)
        self.environment["PWD"] = str(link)
        for cwd in (self.tree, link):
            code, text = self.run_script("lint.sh", cwd=cwd)
            self.assertEqual(code, 0, text)
            self.assertIn(f" {file} -- -DX ", text)
            self.assertIn("lint: 1 files clean", text)

    def test_lint_checks_sources_that_are_joined(self):
        joined = self.tree / "build" / "Unity" / "unity_0_cxx.cxx"
        self.prepare_lint(joined)
        joined.parent.mkdir()
        sources = [self.tree / "src" / "room" / name for name in ("a.cpp", "b.cpp")]
        sources[1].write_text("int b;\n", encoding="utf-8")
        self.git("add", "src")
        joined.write_text("".join(f'#include "{source}"\n' for source in sources), encoding="utf-8")
        code, text = self.run_script("lint.sh")
        self.assertEqual(code, 0, text)
        self.assertEqual(text.count("checked --quiet"), 1, text)
        self.assertIn(f"--config-file={self.tree / '.clang-tidy'}", text)
        self.assertIn(f" {joined} -- -DX ", text)
        self.assertIn("lint: 2 files clean", text)
        sources[1].write_text("double turn = 6.28318;\n", encoding="utf-8")
        self.assertEqual(self.run_script("lint.sh")[0], 1, "each source is looked at for constants")

    def test_lint_checks_again_what_has_changed(self):
        file = self.tree / "src" / "room" / "a.cpp"
        self.prepare_lint(file)
        (self.tree / "build" / "compile_commands.json").write_text(
            json.dumps([{"directory": str(self.tree), "command": f"/usr/bin/c++ -DX -c {file}", "file": str(file)}],
                       indent=2), encoding="utf-8")
        (self.tree / ".clang-tidy").write_text("Checks: '*'\n", encoding="utf-8")
        (self.tree / "src" / "room" / "a.h").write_text("int b;\n", encoding="utf-8")
        file.write_text('#include "a.h"\nint a;\n', encoding="utf-8")
        self.put_tool("clang++", 'exec g++ "$@"\n')
        self.environment["VANTAGE_LINT_CACHE"] = str(self.scratch / "cache")

        def is_checked():
            code, text = self.run_script("lint.sh")
            self.assertEqual(code, 0, text)
            return "checked --quiet" in text

        self.assertTrue(is_checked())
        self.assertFalse(is_checked(), "nothing has changed")
        (self.tree / "src" / "room" / "a.h").write_text("int c;\n", encoding="utf-8")
        self.assertTrue(is_checked(), "what it includes has changed")
        (self.tree / ".clang-tidy").write_text("Checks: 'x'\n", encoding="utf-8")
        self.assertTrue(is_checked(), "the rules have changed")
        file.write_text('#include "a.h"\nint a;  // NOLINT\n', encoding="utf-8")
        self.assertTrue(is_checked(), "a comment has changed")
        self.put_tool("clang-tidy", 'case "$*" in *version*) echo 1;; *) exit 1;; esac\n')
        for _ in range(2):
            self.assertEqual(self.run_script("lint.sh")[0], 1, "a finding is not forgotten")

    def test_lint_finds_constants_that_the_library_has(self):
        file = self.tree / "src" / "room" / "a.cpp"
        self.prepare_lint(file)
        for line, is_fine in (("double turn = 6.28318;\n", False), ("double pi = M_PI;\n", False), ("int M_PIN;\n", True)):
            file.write_text(line)
            code, text = self.run_script("lint.sh")
            self.assertEqual(code == 0, is_fine, text)
            self.assertEqual("<numbers>" in text, not is_fine, text)

    def test_lint_fails_where_git_does(self):
        self.prepare_lint(self.tree / "src" / "room" / "a.cpp")
        shutil.rmtree(self.tree / ".git")
        self.assertNotEqual(self.run_script("lint.sh")[0], 0)

    # ---- fetch_sources.sh

    def archive(self, name: str, files: list[str]) -> bytes:
        data = io.BytesIO()
        with tarfile.open(fileobj=data, mode="w:gz") as tar:
            for file in files:
                entry = tarfile.TarInfo(f"{name}/{file}")
                entry.size = len(file)
                tar.addfile(entry, io.BytesIO(file.encode()))
        return data.getvalue()

    @contextlib.contextmanager
    def index(self, archives: dict[str, bytes]):
        """A package index on this machine."""
        for file, data in archives.items():
            page = self.scratch / "index" / file.rpartition("-")[0]
            page.mkdir(parents=True)
            (page / "index.html").write_text(
                f'<a href="{file}.whl">{file}.whl</a><a href="../files/{file}#sha256=0">{file}</a>', encoding="utf-8")
            (self.scratch / "index" / "files").mkdir(exist_ok=True)
            (self.scratch / "index" / "files" / file).write_bytes(data)

        class Quiet(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                pass

        handler = functools.partial(Quiet, directory=str(self.scratch / "index"))
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
            thread = threading.Thread(target=server.serve_forever)
            thread.start()
            self.environment["PIP_INDEX_URL"] = f"http://user:word@127.0.0.1:{server.server_port}/"
            try:
                yield
            finally:
                server.shutdown()
                thread.join()

    def pin(self, archives: dict[str, bytes]) -> None:
        lines = ["# pinned"]
        for file, data in archives.items():
            name, _, rest = file.rpartition("-")
            lines.append(f"{name}=={rest.removesuffix('.tar.gz')} --hash=sha256:{hashlib.sha256(data).hexdigest()}")
        (self.tree / "scripts" / "sources.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")

    def test_fetch_unpacks_what_is_pinned_and_nothing_else(self):
        archives = {
            "manifold3d-1.2.tar.gz": self.archive("manifold3d-1.2", ["CMakeLists.txt", "setup.py"]),
            "pythoncdt-3.4.tar.gz": self.archive("pythoncdt-3.4", ["CDT/CDT/include/CDT.h"]),
            "highspy-5.6.tar.gz": self.archive("highspy-5.6", ["cmake/sources.cmake", "pyproject.toml"]),
        }
        deps = self.tree / ".deps"
        with self.index(archives):
            self.pin(archives | {"pythoncdt-3.4.tar.gz": b"another"})
            code, text = self.run_script("fetch_sources.sh")
            self.assertEqual(code, 1)
            self.assertIn("pythoncdt-3.4.tar.gz is not the archive that is pinned", text)
            self.assertEqual(list(deps.iterdir()), [])
            self.pin(archives | {"pythoncdt-3.5.tar.gz": b""})
            code, text = self.run_script("fetch_sources.sh")
            self.assertEqual(code, 1)
            self.assertIn("no source archive of pythoncdt 3.5", text)
            self.pin(archives)
            self.assertEqual(self.run_script("fetch_sources.sh")[0], 0)
        self.assertTrue((deps / "manifold" / "CMakeLists.txt").exists())
        self.assertTrue((deps / "cdt" / "include" / "CDT.h").exists())
        self.assertTrue((deps / "highs" / "cmake" / "sources.cmake").exists())
        # The index is gone, and not asked again.
        self.assertEqual(self.run_script("fetch_sources.sh"), (0, ""))

    def test_fetch_says_that_the_index_is_out_of_reach(self):
        self.environment["PIP_INDEX_URL"] = "http://127.0.0.1:9/"
        code, text = self.run_script("fetch_sources.sh")
        self.assertEqual(code, 1)
        self.assertIn("is the Python package index reachable?", text)

    def test_fetch_refuses_what_is_not_pinned(self):
        (self.tree / "scripts" / "sources.txt").write_text("manifold3d>=3\n", encoding="utf-8")
        code, text = self.run_script("fetch_sources.sh")
        self.assertEqual(code, 1)
        self.assertIn("sources.txt:1: not of the form", text)

    # ---- wheel_licences.py and build_wheel_libraries.py

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

    def test_portable_wheel_takes_its_mathematics_from_glibc(self):
        sys.path.insert(0, str(ROOT / "scripts"))
        self.addCleanup(sys.path.remove, str(ROOT / "scripts"))
        portable = importlib.import_module("build_portable_wheels")
        module = self.scratch / "_core.abi3.so"

        def link(source: str) -> pathlib.Path:
            text = f"#include <math.h>\ndouble f(double x) {{ return sin(x) + cos(x) + exp(x) + log(x); }}\n{source}"
            subprocess.run(["gcc", "-shared", "-fPIC", "-fno-builtin", "-x", "c", "-", "-o", str(module), "-lm"], input=text, text=True,
                           check=True)
            return module

        portable.check_mathematics(link(""))
        with self.assertRaisesRegex(portable.Failure, "cos"):
            portable.check_mathematics(link('__attribute__((visibility("hidden"))) double cos(double x) { return x; }'))

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

    # ---- what is fetched, and where is written

    @staticmethod
    def python_lines(text: str) -> list[str]:
        """The commands in a Python source: each list or tuple with its words, and each text alone."""
        found = []
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, (ast.List, ast.Tuple)):
                words = [item.value if isinstance(item, ast.Constant) else ast.unparse(item) for item in node.elts]
                found.append(" ".join(map(str, words)))
            elif isinstance(node, ast.Constant) and isinstance(node.value, str) and " install " not in node.value:
                found.append(node.value)
        return found

    def script_lines(self) -> list[tuple[str, str]]:
        """Each command of the scripts, of the Makefile and of .ci/run, on one line, with its file."""
        files = [*sorted((ROOT / "scripts").glob("*.sh")), ROOT / "Makefile", ROOT / ".ci" / "run"]
        found = []
        for file in files:
            text = file.read_text(encoding="utf-8").replace("\\\n", " ")
            found += [(file.name, line.strip()) for line in text.splitlines() if not line.strip().startswith("#")]
        for file in sorted((ROOT / "scripts").glob("*.py")):
            found += [(file.name, line) for line in self.python_lines(file.read_text(encoding="utf-8"))]
        return found

    @staticmethod
    def faults_of_line(line: str) -> list[str]:
        """What a command fetches without looking at a hash, or runs of what it fetched; where it writes what others may
        have put there before."""
        found = []
        if re.search(r"\bpip3?\b", line) and " install " in line and "--dry-run" not in line:
            if "--require-hashes" not in line and "--no-index" not in line:
                found.append("pip without --require-hashes")
            if "--no-deps" not in line:
                found.append("pip without --no-deps")
        if re.search(r"\bnpm (install|i|add|update)\b|\bnpx\b|\bnpm exec\b", line):
            found.append("npm without the lock")
        if "npm ci" in line and "--ignore-scripts" not in line:
            found.append("npm runs what packages bring")
        if re.search(r"(?<![\w$}])(/tmp|/var/tmp|\$TMPDIR|\$\{TMPDIR[^}]*\})/[\w.-]+", line):
            found.append("a name in /tmp that others can foresee")
        return found

    def test_scripts_take_nothing_by_name_alone(self):
        lines = self.script_lines()
        self.assertEqual([(file, fault, line) for file, line in lines for fault in self.faults_of_line(line)], [])
        self.assertGreaterEqual(sum("--require-hashes" in line for _, line in lines), 3)
        self.assertIn("ignore-scripts=true", (ROOT / "web" / ".npmrc").read_text(encoding="utf-8").split())
        for line in ("pip install --no-deps -r a.txt", "python -m pip install --require-hashes -r a", "npm install",
                     "npm ci --no-audit", "npx esbuild", "cp a /tmp/a.log", "log=$TMPDIR/log", 'cat >"${TMPDIR:-/tmp}/x"'):
            self.assertEqual(len(self.faults_of_line(line)), 1, line)
        for text in ("run(['python', '-m', 'pip', 'install', '--no-deps', name])", "run([tool, '-m', 'pip', 'install', "
                     "*more, '--require-hashes'])", "subprocess.run(('npm', 'install'))", "open('/tmp/a.log')"):
            self.assertEqual([fault for line in self.python_lines(text) for fault in self.faults_of_line(line)][1:], [], text)
            self.assertTrue(any(self.faults_of_line(line) for line in self.python_lines(text)), text)
        for text in ("run(['python', '-m', 'pip', 'install', '--dry-run'])", "os.path.join(folder, 'a.log')"):
            self.assertFalse(any(self.faults_of_line(line) for line in self.python_lines(text)), text)
        for line in ("log=$(mktemp)", "env -i HOME=/tmp x", 'mkdir "$root/tmp" "$root/tmp/x"', "npm ci --ignore-scripts"):
            self.assertEqual(self.faults_of_line(line), [], line)

    def test_requirements_are_locked(self):
        for name, fewest in (("requirements", 6), ("wheel-requirements", 6), ("packaging-requirements", 4)):
            asked = re.findall(r"^([\w.-]+)(?:\[[\w,]+\])?==(\S+)", (ROOT / "python" / f"{name}.txt").read_text(), re.MULTILINE)
            locked = {}
            for line in (ROOT / "python" / f"{name}.lock").read_text().splitlines():
                if not line.startswith("#"):
                    match = re.fullmatch(r"([a-z0-9-]+)==([\w.+!]+)( --hash=sha256:[0-9a-f]{64})+", line)
                    self.assertIsNotNone(match, line)
                    locked[match[1]] = match[2]
            self.assertGreaterEqual(len(asked), fewest)
            for package, version in asked:
                self.assertEqual(locked.get(re.sub(r"[-_.]+", "-", package).lower()), version,
                                 f"{package}: run scripts/pin_python.py python/{name}.txt")
        for place, package in json.loads((ROOT / "web" / "package-lock.json").read_text())["packages"].items():
            self.assertTrue(not place or package.get("integrity", "").startswith("sha512-"), place)

    def test_locks_have_hashes_for_other_machines(self):
        """numpy has a file for each Python and processor; a package of Python alone has one for all."""
        for name in ("numpy", "click"):
            line = re.search(rf"^{name}==.*$", (ROOT / "python" / "requirements.lock").read_text(), re.MULTILINE)[0]
            self.assertEqual(line.count("--hash="), 6 if name == "numpy" else 1, line)

    def test_pinning_asks_for_each_machine(self):
        """pip that has no file of `only` for aarch64, and another hash of `two` for each machine."""
        self.put_tool("python3", f"exec {sys.executable} \"$@\"\n")
        (self.scratch / "pip").mkdir()
        (self.scratch / "pip" / "__init__.py").write_text("")
        (self.scratch / "pip" / "__main__.py").write_text(
            "import hashlib, json, sys\n"
            "names = [line.split('==')[0].strip() for line in open(sys.argv[sys.argv.index('--requirement') + 1])]\n"
            "where = [word for word in sys.argv if word.startswith(('linux_', '3.'))]\n"
            "if 'only' in names and 'linux_aarch64' in where:\n"
            "    sys.exit('ERROR: No matching distribution found for only==1.0')\n"
            "of = lambda name: {'sha256': hashlib.sha256((name + (str(where) if name == 'two' else '')).encode()).hexdigest()}\n"
            "print(json.dumps({'install': [{'metadata': {'name': name, 'version': '1.0'},\n"
            "                               'download_info': {'archive_info': {'hashes': of(name)}}} for name in names]}))\n")
        (self.scratch / "asked.txt").write_text("only==1.0\ntwo==1.0\n")
        self.environment["PYTHONPATH"] = str(self.scratch)
        code, text = self.run_script("pin_python.py", str(self.scratch / "asked.txt"))
        self.assertEqual(code, 0, text)
        self.assertEqual(text.count("only: no file for CPython"), 3, text)
        lines = (self.scratch / "asked.lock").read_text().splitlines()[1:]
        self.assertEqual([line.count("--hash=sha256:") for line in lines], [1, 6])
        (self.scratch / "mine").mkdir()
        code, text = self.run_script("pin_python.py", "--into", str(self.scratch / "mine"), str(self.scratch / "asked.txt"))
        self.assertEqual(code, 0, text)
        self.assertEqual((self.scratch / "mine" / "asked.lock").read_text().count("--hash="), 2)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()

#!/usr/bin/env python3
"""Tests of scripts/: what must fail fails, and what it leaves behind."""

import ast
import contextlib
import functools
import hashlib
import http.server
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import unittest

from script_test import ROOT, ScriptTest


class Scripts(ScriptTest):
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
        files = [*sorted((ROOT / "scripts").glob("*.sh")), *sorted((ROOT / "integrations").glob("*/*.sh")),
                 ROOT / "Makefile", ROOT / ".ci" / "run"]
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
        for folder in ("web", "integrations/cesium"):
            for place, package in json.loads((ROOT / folder / "package-lock.json").read_text())["packages"].items():
                self.assertTrue(not place or package.get("integrity", "").startswith("sha512-"), place)
                self.assertNotIn("resolved", package, place)  # a host

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
    unittest.main()

#!/usr/bin/env python3
"""Tests of scripts/: what must fail fails, and what it leaves behind.

    check_scripts.py [ROOT]
"""

import contextlib
import functools
import hashlib
import http.server
import io
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import threading
import unittest

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


if __name__ == "__main__":
    if len(sys.argv) > 1:
        ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()

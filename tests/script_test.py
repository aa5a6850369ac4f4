"""What tests of scripts/ stand on."""

import io
import os
import pathlib
import shutil
import subprocess
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent


class ScriptTest(unittest.TestCase):
    """A copy of scripts/ in a folder of its own, for each test."""

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

    def archive(self, name: str, files: list[str]) -> bytes:
        data = io.BytesIO()
        with tarfile.open(fileobj=data, mode="w:gz") as tar:
            for file in files:
                entry = tarfile.TarInfo(f"{name}/{file}")
                entry.size = len(file)
                tar.addfile(entry, io.BytesIO(file.encode()))
        return data.getvalue()

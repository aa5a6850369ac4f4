#!/usr/bin/env python3
"""Tests of what makes and checks a release (scripts/check_dist.py, build_program.py, check_program.py): what is wrong must
be found.

    check_release.py [ROOT]
"""

import argparse
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
import unittest.mock
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))

import build_program
import check_dist
import check_program
import debian_archive
import write_sbom


class Release(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dist = pathlib.Path(folder.name)
        self.number = check_dist.version()
        self.plugin = self.write_plugin(self.number)

    def write_plugin(self, told, licence=True):
        file = self.dist / f"vantage_processing-{self.number}.zip"
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("vantage_processing/metadata.txt", f"[general]\nversion={told}\n")
            if licence:
                archive.writestr("vantage_processing/LICENSE", "Apache-2.0")
        return file

    def hashes(self):
        return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in self.dist.iterdir() if file.name != check_dist.SUMS}

    def test_sums(self):
        self.assertEqual(len(check_dist.sum_faults(self.dist, self.hashes())), 1)  # there are none
        check_dist.write_sums(self.dist)
        self.assertEqual(check_dist.sum_faults(self.dist, self.hashes()), [])
        self.plugin.write_bytes(self.plugin.read_bytes() + b"\n")
        self.assertIn(self.plugin.name, check_dist.sum_faults(self.dist, self.hashes())[0])
        check_dist.write_sums(self.dist)
        sums = self.dist / check_dist.SUMS
        sums.write_text(sums.read_text() * 2 + "0" * 64 + "  gone.zip\nno hash\n")
        self.assertEqual(len(check_dist.sum_faults(self.dist, self.hashes())), 3)  # twice, not there, not understood

    def test_versions_and_names(self):
        self.assertEqual(check_dist.file_faults(self.plugin, self.number)[1], [])
        self.assertEqual(len(check_dist.file_faults(self.plugin, "9.9.9")[1]), 1)
        self.assertEqual(len(check_dist.file_faults(self.write_plugin("9.9.9"), self.number)[1]), 1)
        self.assertEqual(len(check_dist.file_faults(self.write_plugin(self.number, licence=False), self.number)[1]), 1)
        self.plugin.write_bytes(b"no zip")
        self.assertEqual(len(check_dist.file_faults(self.plugin, self.number)[1]), 1)
        stranger = self.dist / "notes.txt"
        stranger.touch()
        self.assertIsNone(check_dist.file_faults(stranger, self.number)[0])

    def test_missing_kinds_are_named(self):
        check_dist.write_sums(self.dist)
        found, missing = check_dist.faults(self.dist, self.number)
        self.assertEqual(len(found), 1)  # no bill of materials
        self.assertEqual(len(missing), sum(not kind.may_lack for kind in check_dist.KINDS) - 1)

    def test_the_bill_reads_lists_of_libraries(self):
        libraries = {"zlib": [{"version": "1.3.1", "source": "pool/main/z/zlib/zlib_1.3.1.orig.tar.gz", "sha256": "0" * 64}]}
        row = "zlib | Zlib | zlib.txt | Debian source package: zlib_1.3.1.orig.tar.gz"
        library = write_sbom.from_list(row, libraries)
        self.assertEqual((library.version, library.sha256, library.component()["licenses"]), ("1.3.1", "0" * 64, [{"license": {"id": "Zlib"}}]))
        eigen = write_sbom.from_list("Eigen | MPL-2.0 | Eigen.txt | Debian source package: eigen3 3.4.0-4", {})
        self.assertEqual(eigen.purl, "pkg:deb/debian/eigen3@3.4.0-4?arch=source")
        with self.assertRaises(write_sbom.Failure):
            write_sbom.from_list("what | MIT | what.txt | found somewhere", {})

    def test_tarballs_have_the_same_bytes_again(self):
        tree = self.dist / "tree" / "vantage"
        (tree / "bin").mkdir(parents=True)
        (tree / "bin" / "vantage").write_bytes(b"program")
        packed = []
        for name in ("a.tar.xz", "b.tar.xz"):
            build_program.pack(tree, self.dist / name)
            packed.append((self.dist / name).read_bytes())
            (tree / "bin" / "vantage").touch()
        self.assertEqual(*packed)
        with tarfile.open(self.dist / "a.tar.xz") as archive:
            self.assertEqual([(member.name, member.mode, member.uid) for member in archive],
                             [("vantage", 0o755, 0), ("vantage/bin", 0o755, 0), ("vantage/bin/vantage", 0o755, 0)])

    def test_tarballs_have_what_the_help_of_the_program_names(self):
        build_program.copy_documents(self.dist / "doc")
        named = set()
        for source in (build_program.PROJECT / "src" / "cli").glob("*.cpp"):
            named |= set(re.findall(r"\b(?:docs|tools)/[\w-]+\.(?:md|py)\b", source.read_text(encoding="utf-8")))
        self.assertGreater(len(named), 5)
        self.assertEqual([name for name in sorted(named) if not (self.dist / "doc" / name).is_file()], [])

    def test_what_is_no_program_for_the_target_is_refused(self):
        text = self.dist / "text"
        text.write_text("no program")
        with self.assertRaises(build_program.Failure):
            build_program.check_binary(text, "x86_64-linux-gnu.2.17")
        with self.assertRaises(build_program.Failure):  # Debian's own needs a later glibc
            build_program.check_binary(pathlib.Path(sys.executable).resolve(), "x86_64-linux-gnu.2.17")
        with self.assertRaises(build_program.Failure):
            build_program.check_binary(pathlib.Path(sys.executable).resolve(), "x86_64-linux-musl")

    def test_programs_of_other_processors_ask_for_an_emulator(self):
        other = "aarch64" if platform.machine() == "x86_64" else "x86_64"
        self.assertEqual(build_program.starter(f"{platform.machine()}-linux-gnu.2.17", {}), [])
        self.assertIsNone(check_program.emulator_for(platform.machine()))
        with unittest.mock.patch.dict(os.environ, {"PATH": str(self.dist)}):
            with self.assertRaises(build_program.Failure):
                build_program.starter(f"{other}-linux-gnu.2.17", {"libc": {}})
            with self.assertRaises(check_program.Fault):
                check_program.emulator_for(other)
            emulator = self.dist / f"qemu-{other}-static"
            emulator.touch(0o755)
            self.assertEqual(build_program.starter(f"{other}-linux-musl", {}), [str(emulator)])
            self.assertEqual(check_program.emulator_for(other), emulator)
            with self.assertRaises(build_program.Failure):  # the list has no C library for it
                build_program.starter(f"{other}-linux-gnu.2.17", {"libc": {}})
        with self.assertRaises(check_program.Fault):
            check_program.check(self.dist / "vantage-1.0.0-linux-vax.tar.xz", argparse.Namespace())

    @unittest.skipUnless(shutil.which("dpkg-deb"), "needs dpkg-deb")
    def test_parts_of_packages_are_unpacked_whole_or_not_at_all(self):
        tree = self.dist / "tree"
        (tree / "DEBIAN").mkdir(parents=True)
        (tree / "DEBIAN" / "control").write_text("Package: thing\nVersion: 1\nArchitecture: all\nMaintainer: A <a@b>\nDescription: thing\n")
        for name in ("lib/thing.so", "usr/thing"):
            (tree / name).parent.mkdir()
            (tree / name).write_text(name)
        package = self.dist / "thing.deb"
        subprocess.run(["dpkg-deb", "--build", "--root-owner-group", str(tree), str(package)], stdout=subprocess.DEVNULL, check=True)
        into = debian_archive.unpack(package, self.dist / "thing", "./lib")
        self.assertEqual([file.relative_to(into).as_posix() for file in into.rglob("*")], ["lib", "lib/thing.so"])
        with self.assertRaises(subprocess.CalledProcessError):
            debian_archive.unpack(package, self.dist / "other", "./none")
        self.assertFalse((self.dist / "other").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])

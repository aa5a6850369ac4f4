"""The plugin's zip, installed in a profile of its own and run by qgis_process, as a user's QGIS would.

    PYTHONPATH=build/python QT_QPA_PLATFORM=offscreen python3 integrations/qgis/tests/test_installed.py
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from installed_profile import FOLDER, TOWN, Profile


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.profile = Profile(scratch.name)
        cls.home, cls.qgis = cls.profile.home, cls.profile.process

    def test_the_zip_is_one_folder_and_the_same_each_time(self):
        self.assertEqual({name.split("/")[0] for name in self.profile.names}, {"vantage_processing"})
        for name in ("metadata.txt", "__init__.py", "icon.svg", "LICENSE"):
            self.assertIn(f"vantage_processing/{name}", self.profile.names)
        with tempfile.TemporaryDirectory() as other:
            subprocess.run([sys.executable, FOLDER / "build_zip.py", other], check=True, capture_output=True)
            again = next(pathlib.Path(other).glob("*.zip")).read_bytes()
        self.assertEqual(self.profile.zip.read_bytes(), again)

    def test_qgis_process_lists_describes_and_runs(self):
        listed = self.qgis("list")
        for name in ("volume", "query", "share", "flight"):
            self.assertIn(f"vantage:{name}", listed.stdout, listed.stderr)
        described = self.qgis("help", "vantage:volume")
        self.assertIn("SLICE_HEIGHTS", described.stdout)
        facets, slices = self.home / "facets.gpkg", self.home / "slices.geojson"
        ran = self.qgis("run", "vantage:volume", "--json", "--", f"MISSION={TOWN / 'mission.yaml'}", "SLICE_HEIGHTS=20;40",
                        f"FACETS={facets}", f"SLICES={slices}")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        results = json.loads(ran.stdout[ran.stdout.index("{"):])["results"]
        self.assertGreater(results["VOLUME_M3"], 0)
        told = json.loads(slices.read_text())
        self.assertEqual([one["properties"]["z_m"] for one in told["features"]], [20.0, 40.0])
        self.assertGreater(facets.stat().st_size, 0)

    def test_errors_end_with_a_code(self):
        ran = self.qgis("run", "vantage:volume", "--", "MISSION=absent.yaml", f"FACETS={self.home / 'x.gpkg'}")
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn("absent.yaml", ran.stdout + ran.stderr)
        self.assertNotIn("Traceback", ran.stdout + ran.stderr)
        self.assertFalse((self.home / "x.gpkg").exists())

    def test_without_the_package_it_says_what_to_do(self):
        ran = self.qgis("run", "vantage:volume", "--", f"MISSION={TOWN / 'mission.yaml'}", f"FACETS={self.home / 'x.gpkg'}",
                        without=True)
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn("pip install", ran.stdout + ran.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

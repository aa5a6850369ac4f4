"""The plugin's zip in the desktop program, on a screen in memory: it loads, its dialogs run, their layers are added.

    PYTHONPATH=build/python python3 integrations/qgis/tests/test_desktop.py
"""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from installed_profile import TOWN, Profile

QGIS = shutil.which("qgis.bin") or "qgis"


@unittest.skipUnless(shutil.which("Xvfb"), "needs Xvfb: apt-get install xvfb")
class Desktop(unittest.TestCase):
    def told_by(self, *, without):
        """What in_desktop.py wrote. `without`: without the package vantage."""
        with tempfile.TemporaryDirectory() as home:
            profile = Profile(home)
            told = pathlib.Path(home) / "told.json"
            reader, writer = os.pipe()
            screen = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1600x1200x24"], pass_fds=[writer],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                os.close(writer)
                with os.fdopen(reader) as number:
                    display = f":{number.readline().strip()}"
                environment = {**profile.environment, "DISPLAY": display, "QT_QPA_PLATFORM": "xcb", "VANTAGE_TOWN": str(TOWN),
                               "VANTAGE_TOLD": str(told), **({"PYTHONPATH": ""} if without else {})}
                script = pathlib.Path(__file__).parent / "in_desktop.py"
                ran = subprocess.run([QGIS, "--noversioncheck", "--nologo", "--code", script], env=environment,
                                     capture_output=True, text=True, timeout=600)
            finally:
                screen.terminate()
                screen.wait()
            self.assertTrue(told.is_file(), ran.stderr[-2000:])
            return json.loads(told.read_text())

    def test_dialogs_run_and_their_layers_are_added(self):
        told = self.told_by(without=False)
        self.assertNotIn("error", told)
        self.assertTrue(told["is_loaded"])
        self.assertEqual(told["messages"], [])
        new = {"volume": {"Facets of the volume", "Slices of the volume"}, "query": {"Points with answers"},
               "share": {"Share that is seen"}, "flight": {"Legs of the flight", "Waypoints"}}
        for name, layers in new.items():
            self.assertLessEqual(layers, set(told["ran"][name]), name)

    def test_without_the_package_there_is_one_message(self):
        told = self.told_by(without=True)
        self.assertNotIn("error", told)
        self.assertTrue(told["is_loaded"])
        self.assertEqual(told["ran"], {})
        self.assertEqual(len(told["messages"]), 1)
        self.assertIn("pip install", told["messages"][0])


if __name__ == "__main__":
    unittest.main(verbosity=2)

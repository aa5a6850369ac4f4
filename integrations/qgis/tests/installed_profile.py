"""A profile of QGIS with the plugin's zip installed and enabled, in a folder of its own."""

import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

FOLDER = pathlib.Path(__file__).resolve().parent.parent
TOWN = FOLDER.parent.parent / "examples" / "town"
# The script of Debian 12 hands an option of the desktop program to qgis_process, which refuses it.
QGIS_PROCESS = shutil.which("qgis_process.bin") or "qgis_process"


class Profile:
    """In a folder that is there. `names`: of the files in the zip."""

    def __init__(self, home):
        self.home = pathlib.Path(home)
        self.home.chmod(0o700)
        self.environment = {**os.environ, "HOME": str(home), "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": str(home)}
        for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME"):
            self.environment.pop(name, None)
        subprocess.run([sys.executable, FOLDER / "build_zip.py", home], check=True, capture_output=True)
        self.zip = next(self.home.glob("*.zip"))
        with zipfile.ZipFile(self.zip) as archive:
            self.names = archive.namelist()
            archive.extractall(self.home / ".local/share/QGIS/QGIS3/profiles/default/python/plugins")
        self.process("plugins", "enable", "vantage_processing")

    def process(self, *arguments, without=False):
        """What qgis_process prints. `without`: without the package vantage."""
        environment = {**self.environment, "PYTHONPATH": ""} if without else self.environment
        return subprocess.run([QGIS_PROCESS, *map(str, arguments)], env=environment, capture_output=True, text=True, timeout=300)

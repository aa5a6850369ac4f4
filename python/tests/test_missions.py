"""Mission files through Python give the bits that the program gives."""

import json
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import vantage as vt
from conftest import PROJECT, SHARED

MISSIONS = sorted(path for folder in ("examples", "docs") for path in (PROJECT / folder).rglob("*.yaml"))



def program(*arguments, folder=None):
    return subprocess.run([sys.executable, "-m", "vantage", *map(str, arguments)], capture_output=True, text=True, cwd=folder)


@pytest.mark.parametrize("path", MISSIONS, ids=lambda path: str(path.relative_to(PROJECT)))
def test_same_bits(path, tmp_path):
    try:
        mission = vt.Mission.read(path)
    except vt.Error as error:
        if error.code != "file-not-found":
            raise
        if not (SHARED / "data").is_dir():
            pytest.skip("set VANTAGE_SHARED to the folder that holds data/")
        pytest.skip(f"what it names is made by another step: {error.where}")
    ran = program("compute", path, "-o", tmp_path / "volume.ply", "-q")
    results = mission.run_each()
    assert ran.returncode == int(any(result.empty for result in results)), ran.stderr
    files = sorted(tmp_path.glob("*.ply"))
    assert len(files) == sum(not result.empty for result in results)
    for result, file in zip(sorted(results, key=lambda one: one.mission.target_name), files):
        of_program = vt.Volume.read(file)
        assert np.array_equal(result.vertices, of_program.vertices)
        assert np.array_equal(result.faces, of_program.faces)
        assert np.array_equal(result.cause_of, of_program.cause_of)
        assert result.volume.provenance == of_program.provenance


def test_arguments_mean_what_the_file_means(tmp_path):
    path = PROJECT / "examples" / "plaza" / "mission.yaml"
    of_file = vt.Mission.read(path)
    written = vt.Mission.of(of_file.scene, of_file.target_parts[0], max_range=of_file.range_m)
    (tmp_path / "mission.yaml").write_text(of_file.text(tmp_path))
    assert vt.Mission.read(tmp_path / "mission.yaml").hash == of_file.hash
    assert written.range_m == of_file.range_m


def test_results_are_saved_as_the_program_does(tmp_path):
    result = vt.Mission.read(PROJECT / "examples" / "plaza" / "mission.yaml").run()
    reports = result.save(tmp_path / "volume.ply", tmp_path / "volume.glb")
    assert [pathlib.Path(report).name for report in reports] == ["volume.report.json"]
    report = json.loads(pathlib.Path(reports[0]).read_text())
    assert report["volume_m3"] == result.volume_m3
    again = vt.Volume.read(tmp_path / "volume.ply")
    assert again.hash == result.volume.hash
    assert again.prove(result.scene)["verdict"] == "proved"
    proof = result.mission.certify(tmp_path / "volume.ply", tmp_path / "volume.cert")
    assert proof["verdict"] == "proved"
    checked = subprocess.run([sys.executable, PROJECT / "tools" / "check_certificate.py", tmp_path / "volume.cert"],
                             capture_output=True, text=True)
    assert checked.returncode == 0, checked.stderr


def test_a_volume_of_another_scene_is_not_proved(result, tmp_path):
    result.save(tmp_path / "volume.ply")
    other = vt.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(vt.Error) as raised:
        vt.Volume.read(tmp_path / "volume.ply").prove(other)
    assert raised.value.code == "not-applicable"


def test_the_program(tmp_path):
    ran = program("--version")
    assert ran.returncode == 0 and ran.stdout.strip() == f"vantage {vt.__version__}"
    ran = program("compute", tmp_path / "missing.yaml", "-o", tmp_path / "v.ply")
    assert ran.returncode == 2 and "what to do" in ran.stderr

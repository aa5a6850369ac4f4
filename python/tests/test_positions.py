"""The fewest positions: known answers, brute force, real missions, and attacks on the outer meshes."""

import itertools
import subprocess
import sys

import numpy as np
import pytest
from conftest import PROJECT, SQUARE, box

import vantage as vt
from vantage import _core
from vantage._common_points import Solid, deepest, surely_apart
from vantage._extras import advice

pytest.importorskip("ortools")

SEED = 11


def solid(low, high):
    return vt.Volume.from_arrays(*box(low, high))


def random_boxes(rng, count, size=5.0):
    lows = rng.uniform(0, 10, (count, 3))
    return [(low, low + rng.uniform(0.5, size, 3)) for low in lows]


def check_answer(answer, volumes):
    """Every target is seen from where the answer says, strictly inside."""
    for target, position in enumerate(answer.assigned):
        if target in answer.unseen:
            assert position == -1
            continue
        one = volumes[target]
        mesh = one.volume if isinstance(one, vt.Result) else one
        depth = _core.SolidIndex(mesh._core).depths(answer.positions[position:position + 1])
        assert depth[0] > 0
        assert depth[0] >= answer.depth_m[position] - 1e-12
        assert target in answer.sees[position]
        if isinstance(one, vt.Result):
            assert one.contains(answer.positions[position]).all()
    assert answer.lower_bound <= len(answer)
    assert len(answer.necessary) <= answer.lower_bound
    assert answer.optimal == (len(answer) == answer.lower_bound)


def fewest_by_force(boxes):
    """A common point of boxes can be moved to where each coordinate is the lowest of one of them, and a little more."""
    points = itertools.product(*[sorted({low[axis] for low, _ in boxes}) for axis in range(3)])
    nudged = [np.array(point) + 1e-4 for point in points]
    sets = {frozenset(i for i, (low, high) in enumerate(boxes) if np.all(p > low) and np.all(p < high)) for p in nudged}
    largest = [one for one in sets if one and not any(one < other for other in sets)]
    for count in range(1, len(boxes) + 1):
        if any(len(frozenset().union(*chosen)) == len(boxes) for chosen in itertools.combinations(largest, count)):
            return count
    raise AssertionError


# ---- known answers


def test_boxes_apart_need_a_position_each():
    volumes = [solid((3 * i, 0, 0), (3 * i + 2, 1, 1)) for i in range(4)]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert len(answer) == answer.lower_bound == 4 and answer.optimal
    assert answer.necessary == [0, 1, 2, 3]
    assert str(answer) == "4 positions; 4 are necessary: targets 0, 1, 2, 3 do not meet"
    assert answer.depth_m == pytest.approx([0.5] * 4, rel=0.1)
    assert answer.greatest_depth == 1


def test_a_chain_of_boxes():
    volumes = [solid((i, 0, 0), (i + 1.5, 1, 1)) for i in range(9)]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert len(answer) == answer.lower_bound == 5


def test_one_common_position_is_deep_inside():
    volumes = [solid((0, 0, 0), (4, 4, 4)), solid((2, 0, 0), (9, 4, 4))]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert str(answer) == "1 position; 1 is necessary"
    assert answer.sees == [[0, 1]]
    assert answer.depth_m[0] >= 0.9


def three_sides():
    """Three volumes; each two of them meet, not all three."""
    third = solid((9, 0, 0), (10, 10, 1)) | solid((0, 9, 0), (10, 10, 1))
    return [solid((0, 0, 0), (10, 1, 1)), solid((0, 0, 0), (1, 10, 1)), third]


def test_three_that_meet_in_pairs_need_two():
    volumes = three_sides()
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert len(answer) == answer.lower_bound == 2
    assert len(answer.necessary) == 1 and answer.greatest_depth == 2
    assert str(answer) == "2 positions; 2 are necessary: no position sees more than 2 of 3 targets"


def test_closed_sets_that_touch_are_not_apart():
    """No position lies inside of both, and nothing proves that none sees both."""
    volumes = [solid((0, 0, 0), (1, 1, 1)), solid((1, 0, 0), (2, 1, 1))]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert len(answer) == 2 and answer.lower_bound == 1 and not answer.optimal
    assert str(answer) == "2 positions; at least 1 is necessary"
    assert answer.notes


@pytest.mark.parametrize("gap, bound", [(0.0, 1), (1e-12, 1), (1e-9, 1), (1e-6, 2)])
def test_what_rounding_may_close_is_not_apart(gap, bound):
    volumes = [solid((0, 0, 0), (1, 1, 1)), solid((1 + gap, 0, 0), (2, 1, 1))]
    assert vt.fewest_positions(volumes).lower_bound == bound


def test_greedy_is_not_enough():
    """The deepest point sees four; the best two see three each."""
    spans = [(0, 4), (1, 5), (2, 6.5), (6, 9.5), (6, 10), (9, 12)]  # on a line: 2.5 sees three, 9.25 sees three
    volumes = [solid((a, 0, 0), (b, 1, 1)) for a, b in spans]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    assert len(answer) == answer.lower_bound == 2


def test_random_boxes_against_brute_force():
    print("seed", SEED)
    rng = np.random.default_rng(SEED)
    for _ in range(25):
        boxes = random_boxes(rng, int(rng.integers(2, 9)), 8.0)
        volumes = [solid(low, high) for low, high in boxes]
        answer = vt.fewest_positions(volumes)
        check_answer(answer, volumes)
        assert len(answer) == fewest_by_force(boxes)
        assert answer.lower_bound == len(answer)


def test_a_hundred_boxes_in_any_order():
    print("seed", SEED)
    boxes = random_boxes(np.random.default_rng(SEED), 100)
    volumes = [solid(low, high) for low, high in boxes]
    answer = vt.fewest_positions(volumes)
    check_answer(answer, volumes)
    turned = vt.fewest_positions(volumes[::-1])
    assert len(turned) == len(answer) and answer.optimal
    again = vt.fewest_positions(volumes, threads=1)
    assert np.array_equal(again.positions, answer.positions) and again.sees == answer.sees


# ---- searching


def test_the_deepest_point_is_found_and_bounded():
    found = deepest([Solid(solid((0, 0, 0), (10, 6, 4))._core)], 0.0, share=0.99)
    assert 0.99 * 2 <= found.depth_m <= 2 <= found.most_m <= found.depth_m / 0.98


def test_apart_is_certain_only_with_a_gap():
    volumes = [Solid(one._core) for one in three_sides()]
    assert surely_apart(volumes)
    assert not surely_apart(volumes[:2])
    touching = [Solid(solid((i, 0, 0), (i + 1, 1, 1))._core) for i in range(2)]
    assert not surely_apart(touching)


def test_no_deep_point_is_missed():
    print("seed", SEED)
    rng = np.random.default_rng(SEED)
    for _ in range(200):
        boxes = random_boxes(rng, 3, 9.0)
        low, high = np.max([b[0] for b in boxes], axis=0), np.min([b[1] for b in boxes], axis=0)
        depth = float((high - low).min()) / 2
        found = deepest([Solid(solid(*one)._core) for one in boxes], 0.0)
        if depth > 0:
            assert found.point is not None and 0.9 * depth - 1e-9 <= found.depth_m <= depth + 1e-9
        else:
            assert found.point is None
        assert found.most_m >= min(depth, 0) - 1e-9


# ---- candidates and costs


def line(*spans):
    return [solid((a, 0, 0), (b, 1, 1)) for a, b in spans]


def test_candidates_are_the_only_choice():
    volumes = line((0, 2), (1, 3), (2.5, 5))
    answer = vt.fewest_positions(volumes, candidates=[[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [4, 0.5, 0.5], [2, 0.5, 0.5]])
    check_answer(answer, volumes)
    assert answer.positions.tolist() == [[1.5, 0.5, 0.5], [4, 0.5, 0.5]]
    assert answer.optimal and answer.lower_bound == 2


def test_candidates_on_the_boundary_do_not_count():
    """The first lies on a face of volume 0."""
    answer = vt.fewest_positions(line((0, 2), (1, 3)), candidates=[[2, 0.5, 0.5], [0.5, 0.5, 0.5]])
    assert sorted(answer.sees) == [[0], [1]] and answer.unseen == []


def test_what_no_candidate_sees_is_unseen():
    answer = vt.fewest_positions(line((0, 2), (10, 12)), candidates=[[1, 0.5, 0.5]])
    assert answer.unseen == [1] and answer.assigned.tolist() == [0, -1]
    assert str(answer).endswith("1 target without an answer")


def test_costs_of_candidates():
    volumes = line((0, 4), (2, 6))
    candidates = [[3, 0.5, 0.5], [1, 0.5, 0.5], [5, 0.5, 0.5]]
    dear = vt.fewest_positions(volumes, candidates=candidates, cost=[5, 1, 1])
    assert dear.total_cost == 2 and len(dear) == 2 and dear.optimal
    cheap = vt.fewest_positions(volumes, candidates=candidates, cost=lambda points: points[:, 0] * 0 + 1)
    assert cheap.total_cost == 1 and cheap.positions.tolist() == [[3, 0.5, 0.5]]


def test_a_cost_without_candidates():
    volumes = line((0, 4), (2, 6))
    answer = vt.fewest_positions(volumes, cost=lambda points: points[:, 0])
    assert answer.total_cost == pytest.approx(answer.positions[:, 0].sum())
    assert not answer.optimal and answer.notes and answer.lower_bound == 1
    assert all(position >= 0 for position in answer.assigned)


# ---- real missions


def squares_in_plaza():
    scene = vt.Scene.from_mesh(PROJECT / "examples" / "plaza" / "plaza.obj")
    places = [(0, 0), (-60, -50), (60, 50), (-60, 50), (55, -50)]
    targets = [[[x - 2, y - 2, 0.2], [x + 2, y - 2, 0.2], [x + 2, y + 2, 0.2], [x - 2, y + 2, 0.2]] for x, y in places]
    results = []
    for target in targets:
        try:
            results.append(vt.compute(scene, target, max_range=60, navigation=vt.Navigation(altitude=(3, 50))))
        except vt.Error as error:
            assert error.code == "target-pierced"  # noqa: PT017
    return [one for one in results if not one.empty]


def test_squares_of_the_plaza():
    results = squares_in_plaza()
    assert len(results) >= 3
    answer = vt.fewest_positions(results)
    check_answer(answer, results)
    assert answer.lower_bound >= 2
    # Nobody sees two of the witnesses: tried with places in both.
    rng = np.random.default_rng(SEED)
    points = rng.uniform((-80, -70, 3), (80, 70, 50), (20000, 3))
    seen = np.array([results[i].contains(points) for i in answer.necessary])
    assert seen.sum(axis=0).max() == 1


def outer_of(result):
    return _core.SolidIndex(_core.outer_volume(result.mission._core, 0.0, 0.01, 0, None)[0])


def hard_points(result, rng, count):
    """On both sides of the surface, at all scales, and anywhere."""
    corners = result.vertices[result.faces[rng.integers(len(result.faces), size=count)]]
    at = (corners * rng.dirichlet([1, 1, 1], count)[:, :, None]).sum(axis=1)
    centre = np.mean(result.mission.target_parts[0], axis=0)
    off = 10 ** rng.uniform(-9, -2, count) * rng.choice([-1, 1], count)
    anywhere = rng.uniform(result.vertices.min(axis=0), result.vertices.max(axis=0), (count, 3))
    return np.concatenate([centre + (at - centre) * (1 + off)[:, None], anywhere])


def attack(result, index, rng, count=4000):
    """How many points see the whole target and lie outside of a mesh, and how many see it."""
    points = hard_points(result, rng, count)
    sees = result.contains(points)
    return int((index.depths(points)[sees] < 0).sum()), int(sees.sum())


def test_outer_meshes_hold_every_position(scene):
    """And the mesh that is not moved out does not: the points are hard enough."""
    print("seed", SEED)
    rng = np.random.default_rng(SEED)
    plaza = squares_in_plaza()
    wall = vt.Target(vertices=[[0, 0, 3], [4, 0, 3], [4, 0, 6], [0, 0, 6]], sides="both")
    both = vt.compute(scene, wall, max_range=70)
    for result in [*plaza, both, vt.compute(scene, SQUARE, max_range=40)]:
        outside, seen = attack(result, outer_of(result), rng)
        assert seen > 500 and outside == 0
    coarse = vt.compute(scene, SQUARE, max_range=40, tolerance=0.04)
    assert attack(coarse, _core.SolidIndex(coarse.volume._core), rng)[0] > 20


def test_roofs_and_squares_in_munich(shared):
    scene = vt.Scene.from_mesh(shared / "mesh" / "munich_merged.ply")
    corners = scene.vertices[scene.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    near = (np.abs(corners.mean(axis=1)[:, :2]) < 200).all(axis=1)
    roofs = np.flatnonzero((np.abs(normals[:, 2]) > 60) & near & (corners[:, :, 2].min(axis=1) > 8))
    rng, results = np.random.default_rng(SEED), []
    print("seed", SEED)
    while len(results) < 8:
        x, y = rng.uniform(-200, 200, 2)
        square = [[x - 4, y - 4, 0.5], [x + 4, y - 4, 0.5], [x + 4, y + 4, 0.5], [x - 4, y + 4, 0.5]]
        is_roof = len(results) % 2 == 1
        target = vt.Target(vertices=corners[rng.choice(roofs)], offset=0.05) if is_roof else square
        try:
            result = vt.compute(scene, target, max_range=200, navigation=vt.Navigation(altitude=(20, 120)))
        except vt.Error:
            continue
        if not result.empty:
            results.append(result)
    for result in results:
        assert attack(result, outer_of(result), rng, 1000)[0] == 0
    answer = vt.fewest_positions(results)
    check_answer(answer, results)
    assert 1 < len(answer) < len(results)
    for seen, position in zip(answer.sees, answer.positions):
        assert all(results[target].contains(position)[0] for target in seen)


def test_inner_meshes_that_are_apart_prove_nothing():
    """Coarse meshes of two squares 93 m apart do not meet. What is seen of them from less than 50 m does."""
    flat = [[-200, -200, 0], [200, -200, 0], [200, 200, 0], [-200, 200, 0]]
    ground = vt.Scene.from_arrays(flat, [[0, 1, 2], [0, 2, 3]])
    along = np.array([46.5 * np.cos(0.61), 46.5 * np.sin(0.61), 1])  # where facets are largest
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])

    def volumes(max_range, tolerance):
        return [vt.compute(ground, corners + along * [sign, sign, 1], max_range=max_range, tolerance=tolerance,
                           navigation=vt.Navigation(altitude=(15, 30))) for sign in (-1, 1)]

    coarse = volumes(50, 4.0)
    assert not Solid(coarse[0].volume._core).meets(Solid(coarse[1].volume._core))
    assert str(vt.fewest_positions(coarse)) == "2 positions; at least 1 is necessary"
    assert str(vt.fewest_positions(volumes(50, 0.01))) == "1 position; 1 is necessary"
    assert str(vt.fewest_positions(volumes(46, 4.0))) == "2 positions; 2 are necessary: targets 0, 1 do not meet"


def test_a_result_without_a_volume_is_unseen(scene, result):
    hidden = vt.compute(scene, SQUARE, max_range=60, navigation=vt.Navigation(altitude=(90, 99)))
    assert hidden.empty
    answer = vt.fewest_positions([hidden, result])
    assert answer.unseen == [0] and answer.sees == [[1]] and answer.assigned.tolist() == [-1, 0]
    assert str(answer) == "1 position; 1 is necessary; 1 target without an answer"


# ---- bad input


@pytest.mark.parametrize("arguments, code, where", [
    (dict(volumes=[]), "nothing-given", "volumes"),
    (dict(volumes=[1]), "wrong-type", "volumes[0]"),
    (dict(volumes="a"), "wrong-type", "volumes[0]"),
    (dict(volumes=solid((0, 0, 0), (1, 1, 1))), "wrong-type", "volumes"),
    (dict(candidates=[[0, 0]]), "array-sizes-differ", "candidates"),
    (dict(candidates=[[0, 0, float("nan")]]), "coordinate-not-finite", "candidates"),
    (dict(candidates=[[0.5, 0.5, 0.5]], cost=[1, 2]), "array-sizes-differ", "cost"),
    (dict(candidates=[[0.5, 0.5, 0.5]], cost=[-1]), "value-out-of-range", "cost"),
    (dict(cost=[1]), "conflicting-keys", "cost"),
    (dict(time_limit_s=0), "value-out-of-range", "time_limit_s"),
    (dict(time_limit_s=float("nan")), "value-out-of-range", "time_limit_s"),
])
def test_bad_input_is_refused(arguments, code, where):
    arguments = {"volumes": [solid((0, 0, 0), (1, 1, 1))], **arguments}
    with pytest.raises(vt.InputError) as caught:
        vt.fewest_positions(**arguments)
    assert caught.value.code == code and caught.value.where == where and caught.value.fix


def test_without_or_tools_the_extra_is_named():
    code = ("import sys; sys.modules['ortools'] = None\n"
            "import vantage as vt\n"
            "try:\n    vt.fewest_positions([])\n"
            "except vt.Error as error:\n    print(error.code, error.fix)")
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env={"PYTHONPATH": ":".join(sys.path)})
    assert told.stdout.strip() == f"component-missing {advice('positions')}"


def test_progress_is_told_and_stops():
    volumes = line((0, 2), (1, 3), (5, 6))
    stages = []
    vt.fewest_positions(volumes, progress=lambda stage, fraction: stages.append((stage, fraction)))
    assert {"outer", "candidates", "pairs"} <= {stage for stage, _ in stages}
    assert all(0 <= fraction <= 1 for _, fraction in stages)
    with pytest.raises(vt.CancelledError):
        vt.fewest_positions(volumes, progress=lambda stage, fraction: False)


def test_time_that_runs_out_is_told():
    print("seed", SEED)
    boxes = random_boxes(np.random.default_rng(SEED), 60, 9.0)
    volumes = [solid(low, high) for low, high in boxes]
    answer = vt.fewest_positions(volumes, time_limit_s=1e-3)
    check_answer(answer, volumes)
    assert answer.unseen == [] and answer.notes


def test_targets_that_no_candidate_sees_are_unseen():
    """Also if none sees any, and if there are no candidates."""
    volumes = line((0, 2), (10, 12))
    for candidates in ([[1000, 0, 0]], [], np.zeros((0, 3))):
        for cost in (None, lambda points: np.ones(len(points))):
            answer = vt.fewest_positions(volumes, candidates=candidates, cost=cost)
            assert answer.unseen == [0, 1] and answer.assigned.tolist() == [-1, -1]
            assert answer.positions.shape == (0, 3) and answer.sees == [] and len(answer.depth_m) == 0
            assert answer.lower_bound == 0 and answer.optimal and answer.total_cost == 0
            assert str(answer) == "0 positions; 0 are necessary; 2 targets without an answer"
            assert "0 positions" in answer._repr_html_()


def test_errors_in_the_place_of_results_are_unseen(result):
    wrong = vt.InputError("input", "target-pierced", "pierced", "", "")
    answer = vt.fewest_positions([wrong, result])
    assert answer.unseen == [0] and answer.sees == [[1]]


SIGNALS = """
import os, signal, sys, threading, time
sys.path.insert(0, {tests!r})
import vantage as vt
from test_positions import line, random_boxes, solid
import numpy as np
signal.signal(signal.SIGINT, signal.default_int_handler)
"""


def interrupted(text):
    ran = subprocess.run([sys.executable, "-c", SIGNALS.format(tests=str(PROJECT / "python" / "tests")) + text],
                         capture_output=True, text=True, timeout=120)
    return ran.stdout, ran.stderr


def test_the_solver_leaves_ctrl_c_to_python():
    told, said = interrupted("""
print(vt.fewest_positions(line((0, 2), (1, 3), (5, 6))), signal.getsignal(signal.SIGINT) is signal.default_int_handler)
try:
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(5)
except KeyboardInterrupt:
    print("heard")
""")
    assert told == "2 positions; 2 are necessary: targets 0, 2 do not meet True\nheard\n", said


HARD = """
from vantage import _cover
from vantage._cover import Clock
rng = np.random.default_rng(3)
sets = [sorted(set(rng.integers(0, 300, 9).tolist())) for _ in range(1500)] + [[i] for i in range(300)]
_cover.cp_model()
"""


def test_ctrl_c_stops_the_solver():
    told, said = interrupted(HARD + """
threading.Timer(1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
began = time.monotonic()
try:
    _cover.least_cover(300, sets, [1] * len(sets), Clock(100))
    print("it was solved")
except KeyboardInterrupt:
    print("heard", time.monotonic() - began < 20)
    time.sleep(1)
    print(any("CP-SAT" in one.name for one in threading.enumerate()))
""")
    assert told == "heard True\nFalse\n", said


def test_a_callback_stops_the_solver():
    from vantage import _cover

    rng = np.random.default_rng(3)
    sets = [sorted(set(rng.integers(0, 300, 9).tolist())) for _ in range(1500)] + [[i] for i in range(300)]

    def check():
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        _cover.least_cover(300, sets, [1] * len(sets), _cover.Clock(100, check))


def test_outer_meshes_and_candidates_look_at_the_clock(monkeypatch):
    """No outer mesh is made when time is over, and no volume is asked for the candidates of others."""
    from vantage import _position_search

    results = squares_in_plaza()
    made, asked = [], []
    make, holds = _core.outer_volume, _position_search.Region.holds
    monkeypatch.setattr(_core, "outer_volume", lambda *arguments: made.append(1) or make(*arguments))
    monkeypatch.setattr(_position_search.Region, "holds",
                        lambda region, points, threads: asked.append(len(points)) or holds(region, points, threads))
    cut = vt.fewest_positions(results, time_limit_s=1e-6)
    check_answer(cut, results)
    assert made == [] and max(asked) <= max(len(cut), _position_search._LAST_TRIES)
    assert cut.unseen == [] and cut.lower_bound == 1 and "time ran out" in cut.notes[0]
    whole = vt.fewest_positions(results)
    assert len(made) == len(results) and whole.lower_bound >= 2 and len(whole) <= len(cut)


def test_an_outer_mesh_is_stopped_when_time_is_over():
    """In the middle of it."""
    from vantage._cover import Clock
    from vantage._position_search import Region

    wall = vt.Target(vertices=[[0, 0, 3], [4, 0, 3], [4, 0, 6], [0, 0, 6]])
    scene = vt.Scene.from_mesh(PROJECT / "examples" / "plaza" / "plaza.obj")
    result = vt.compute(scene, wall, max_range=60)
    calls = []

    class Soon(Clock):
        @property
        def left_s(self):
            calls.append(1)
            return 0.0 if len(calls) > 1 else 1.0

    region = Region(result, "one")
    done = region.surround(0, Soon(1))
    # It takes more than the 0.05 s after which the clock is asked again, or it is done before.
    assert done == (region.outer is not None) and region.surround(0, Clock(60)) and region.outer is not None

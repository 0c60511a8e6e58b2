# SPDX-License-Identifier: BSD-3-Clause
"""Data sets of random poses with all their solutions."""

from __future__ import annotations

import numpy as np
import pytest
import reach_maps  # noqa: F401 (skips without the extra)
from command_line import assert_bad, assert_good

import iksel
from iksel import reach
from iksel.reach import _samples


@pytest.mark.parametrize("targets", reach.TARGETS)
def test_samples_are_poses_with_their_solutions(made, tmp_path, targets, monkeypatch):
    monkeypatch.setattr(_samples, "CHUNK", 200)
    robot = made.robot("ur5e")
    plan = reach.plan_samples(robot, 500, seed=4, targets=targets, max_solutions=6)
    assert plan.chunks == 3
    store = reach.create(plan, tmp_path / "a.zarr")
    reach.run(store.path, workers=1)
    chunks = [store.read(i) for i in range(3)]
    assert [len(c["count"]) for c in chunks] == [200, 200, 100]
    solver, counts = iksel.Solver(robot), []
    columns = [np.concatenate([c[s.name] for c in chunks]) for s in plan.specs()]
    for row in zip(*columns, strict=True):
        position, quaternion, status, proof, count, q = row
        pose = iksel.pose_from_quaternion(position, quaternion)
        found = solver.solve_all(pose, max=6)
        assert (status, proof, count) == (found.status, found.proof, len(found.q))
        assert np.isnan(q[count:]).all()
        if count:
            reached = robot.fk(q[:count])
            np.testing.assert_allclose(reached, np.tile(pose, (count, 1, 1)), atol=2e-6)
        distance = np.linalg.norm(position - robot.reach_centre)
        assert distance <= robot.reach * (1 + 1e-9)
        counts.append(count)
    assert max(counts) == 6
    assert (min(counts) > 0) == (targets == "configurations")


def test_the_seed_and_not_the_engine_says_which_samples(made, tmp_path, monkeypatch):
    monkeypatch.setattr(_samples, "CHUNK", 100)
    engines = pytest.importorskip(
        "bench.reach.engines", reason="only in the repository"
    )
    stores = {}
    for name, seed in {"a": 2**64 - 1, "b": 2**64 - 1, "c": 1}.items():
        plan = reach.plan_samples(made.robot("ur5e"), 300, seed=seed)
        stores[name] = reach.create(plan, tmp_path / f"{name}.zarr").path
        reach.run(stores[name], workers=2 if name == "b" else 1)
    assert engines.digests(stores["a"]) == engines.digests(stores["b"])
    first = [reach.Store(stores[name]).read(0)["position"] for name in "ac"]
    assert not np.isin(first[0], first[1]).any()
    chunks = [reach.Store(stores["a"]).read(i)["position"] for i in range(2)]
    assert not np.isin(chunks[0], chunks[1]).any()


def test_parquet_files_from_the_command_line(run, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pip install iksel[reach]")
    store, folder = tmp_path / "a.zarr", tmp_path / "a.parquet"
    line = f"dataset ur5e --samples 300 --targets poses -o {store} --parquet {folder}"
    assert_good(run(line))
    assert_good(run(line))  # goes on, with nothing left to do
    (file,) = folder.iterdir()
    table = parquet.read_table(file).to_pydict()
    arrays = reach.Store(store).read(0)
    np.testing.assert_array_equal(np.array(table["position"]), arrays["position"])
    for q, count, stored in zip(table["q"], table["count"], arrays["q"], strict=True):
        np.testing.assert_array_equal(np.array(q).reshape(-1, 6), stored[:count])
    assert_bad(run(f"reach view {store} -o {tmp_path}/a.png"), "samples, not a map")
    assert_good(run("reach", "status", store))
    assert_bad(run(line.replace("300", "200")), "another plan")
    assert_bad(run(line + " --max-solutions 300"), "max_solutions")


@pytest.mark.parametrize(
    ("settings", "culprit"),
    [
        ({"samples": 0}, "samples"),
        ({"seed": -1}, "seed"),
        ({"targets": "dreams"}, "configurations, poses"),
        ({"max_solutions": 255}, "max_solutions"),
    ],
)
def test_a_data_set_out_of_range_is_refused(made, settings, culprit):
    with pytest.raises(iksel.InvalidArgumentError, match=culprit):
        reach.plan_samples(made.robot("ur5e"), **{"samples": 5} | settings)

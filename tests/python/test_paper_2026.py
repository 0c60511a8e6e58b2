# SPDX-License-Identifier: BSD-3-Clause
"""The authors' newer selection of seeds against numpy, written from its description."""

from __future__ import annotations

import numpy as np
import pytest

import iksel

pytest.importorskip("bench", reason="the benchmarks are in the repository only")

from bench.chain import chain_from_urdf
from bench.paper.newer import NewerSelection

SEED = 26
NAMES = ["cvr038", "cvrb1213", "ur3_wrs", "irb14050", "panda"]


@pytest.mark.parametrize("name", NAMES)
def test_it_is_what_its_description_says(name: str, cases: int) -> None:
    robot = iksel.load_robot(name).with_tcp(np.eye(4))
    options = iksel.SolverOptions.paper(2026)
    options.database.kmeans_pool = 20_000
    options.database.kmeans_rounds = 5
    solver = iksel.Solver(robot, options)
    database = solver.database
    assert len(database) == 2048
    chain = chain_from_urdf(robot.urdf, robot.base_link, robot.tip_link, np.eye(4))
    samples = np.array([database.q(i) for i in range(len(database))])
    oracle = NewerSelection(chain, samples)
    selector = iksel.Selector(database, options.strategy)
    targets = chain.fk(robot.random_configurations(min(cases, 60), SEED))
    solved = 0
    for target in targets:
        best = selector.candidates(target)[0][:16]
        np.testing.assert_array_equal(best, oracle.seeds(target), f"seed {SEED}")
        expected = oracle.solve(target)
        result = solver.solve(target)
        assert (result.attempts, result.iterations) == expected[1:], f"seed {SEED}"
        assert result.success is (expected.q is not None)
        if result:
            np.testing.assert_allclose(result.q, expected.q, rtol=0, atol=1e-8)
        solved += result.success
    assert solved > 0.9 * len(targets)


def test_years_that_there_are() -> None:
    for options in (iksel.DatabaseOptions, iksel.SolverOptions):
        assert options.paper() == options.paper(2025) == options.paper(year=2025)
        assert options.paper(2026) != options.paper()
        options.paper(2026).validate()
        with pytest.raises(iksel.InvalidArgumentError, match="2024.*2025, 2026"):
            options.paper(2024)
    newer = iksel.SolverOptions.paper(2026)
    assert newer.database == iksel.DatabaseOptions.paper(2026)

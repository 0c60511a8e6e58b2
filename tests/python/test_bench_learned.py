# SPDX-License-Identifier: BSD-3-Clause
"""The laws of the learned models, of their training, and of the committed weights."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("bench", reason="the benchmarks are in the repository only")
pytest.importorskip("jax", reason="trains and runs the learned seeds")
pytest.importorskip("equinox", reason="has the layers of the learned seeds")
pytest.importorskip("optax", reason="trains the learned seeds")

import equinox as eqx
import jax
import jax.numpy as jnp
from bench.arms import PAPER_ARMS, load_arm
from bench.learned import data, evaluate, flow, models, plan, train
from bench.learned.diffusion import Diffusion, schedule
from bench.learned.errors import batch_errors
from bench.learned.mdn import Mdn

import iksel

SEED = 7
REPORTED = [
    (robot, model, recipe)
    for robot in PAPER_ARMS
    for model in plan.MODELS
    for recipe in plan.recipes(robot, model)
]
MANY = 16_000_000
"""Bytes that all committed weights may have."""


@pytest.fixture
def x():
    return jax.random.normal(jax.random.key(SEED), (5, data.FEATURES))


class TestLabels:
    @pytest.mark.parametrize("robot", ["cvr038", "irb14050"])
    def test_reach_the_poses_inside_the_limits(self, robot):
        arm = load_arm(robot)
        poses = arm.robot.fk(arm.robot.random_configurations(50, SEED))
        q = data.labels(arm, poses)
        known = np.isfinite(q).all(axis=1)
        assert known.sum() >= 49
        assert np.abs(arm.chain.fk(q[known]) - poses[known]).max() < 1e-5
        assert arm.chain.within_limits(q[known]).all()

    def test_of_six_joints_are_the_nearest_to_the_middle(self):
        arm = load_arm("cvr038")
        solver = iksel.Solver(arm.robot)
        poses = arm.robot.fk(arm.robot.random_configurations(50, SEED))
        middle = arm.chain.middle()
        for pose, q in zip(poses, data.labels(arm, poses), strict=True):
            every = solver.solve_all(pose).q
            least = np.linalg.norm(every - middle, axis=1).min()
            assert np.linalg.norm(q - middle) <= least + 1e-4

    def test_are_kept(self, tmp_path, monkeypatch):
        monkeypatch.setattr(data, "WORK", tmp_path)
        made = data.labelled("ur3_wrs", 20, SEED)
        monkeypatch.setattr(data, "labels", None)
        read = data.labelled("ur3_wrs", 20, SEED)
        assert all(np.array_equal(*pair) for pair in zip(made, read, strict=True))

    def test_drawn_ones_are_other_configurations_of_the_same_poses(self):
        arm = load_arm("ur3_wrs")
        features, q = data.labelled_now(arm, 200, SEED, plan.Recipe("drawn"))
        assert np.abs(data.features(arm.robot.fk(q)) - features).max() < 1e-6
        same, nearest = data.labelled_now(arm, 200, SEED)
        assert np.array_equal(features, same)
        assert np.mean(np.abs(q - nearest).max(axis=1) > 1e-3) > 0.5

    @pytest.mark.parametrize("inputs", plan.INPUTS)
    def test_inputs_tell_the_rotation(self, inputs):
        arm = load_arm("ur3_wrs")
        recipe = plan.Recipe("drawn", inputs)
        x, q = data.labelled_now(arm, 200, SEED, recipe)
        poses = arm.robot.fk(q)
        if inputs == "quaternion":
            assert (x[:, 3] >= 0.0).all()
            rotations = iksel.pose_from_quaternion(x[:, :3], x[:, 3:])[:, :3, :3]
        else:
            rotations = x[:, 3:].reshape(-1, 3, 3)
        assert np.abs(rotations - poses[:, :3, :3]).max() < 1e-5
        scaling = data.scaling_of(x, q)
        again = scaling.inputs(poses) * scaling.x_std + scaling.x_mean
        assert np.abs(again - x).max() < 1e-4

    def test_scaling_goes_there_and_back(self):
        features, q = data.labelled_now(load_arm("ur3_wrs"), 200, SEED)
        scaling = data.scaling_of(features, q)
        scaled = (q - scaling.q_mean) / scaling.q_std
        assert scaled.std(axis=0) == pytest.approx(1.0, abs=1e-4)
        assert np.abs(scaling.joints(scaled) - q).max() < 1e-5


class TestMdn:
    def test_density_integrates_to_one(self, x):
        model = Mdn(1, jax.random.key(SEED))
        grid = jnp.linspace(-20.0, 20.0, 4_001)[:, None]
        step = float(grid[1, 0] - grid[0, 0])
        for row in x[:2]:
            logs = model.log_density(grid, jnp.broadcast_to(row, (len(grid), 12)))
            assert step * np.exp(logs).sum() == pytest.approx(1.0, abs=1e-3)

    def test_output_is_the_mean_of_the_likeliest_component(self, x):
        model = Mdn(6, jax.random.key(SEED))
        log_weights, means, _ = model.mixture(x)
        out = model.outputs(x, jax.random.key(0), 2)
        for i, best in enumerate(np.argmax(log_weights, axis=1)):
            assert np.array_equal(out[i], np.stack([means[i, best]] * 2))


class TestFlow:
    @pytest.fixture
    def model(self):
        return flow.Flow(6, jax.random.key(SEED), 24)

    @pytest.fixture
    def context(self, model, x):
        # Ten times what random weights give, so that the layers do something.
        return 10.0 * model.context(x, jnp.zeros((len(x), 1)))

    @pytest.fixture
    def v(self, x):
        return jax.random.normal(jax.random.key(SEED + 1), (len(x), flow.WIDTH))

    def test_inverse(self, model, context, v):
        z, _ = model.forward(v, context)
        assert np.abs(z - v[:, flow.ORDERS[0]]).max() > 0.1
        assert np.abs(model.inverse(z, context) - v).max() < 1e-4

    def test_log_determinant(self, model, context, v):
        """The oracle is the determinant of the Jacobian by automatic derivatives."""
        _, log_det = model.forward(v, context)
        for i in range(len(v)):
            jacobian = jax.jacfwd(lambda a, c=context[i]: model.forward(a, c)[0])(v[i])
            _, expected = np.linalg.slogdet(np.asarray(jacobian, dtype=float))
            assert float(log_det[i]) == pytest.approx(expected, abs=1e-4)

    def test_samples_differ_and_repeat(self, model, x):
        first = model.outputs(x, jax.random.key(1), 3)
        assert first.shape == (5, 3, 6)
        assert np.array_equal(first, model.outputs(x, jax.random.key(1), 3))
        assert not np.array_equal(first[:, 0], first[:, 1])


class TestDiffusion:
    def test_schedule(self):
        share, noise = schedule(jnp.linspace(0.0, 1.0, 101))
        assert np.abs(share**2 + noise**2 - 1.0).max() < 1e-6
        assert (share[0], noise[0]) == (1.0, 0.0)
        assert (np.diff(share) < 0.0).all()
        assert share[-1] == pytest.approx(0.0, abs=1e-6)

    @pytest.mark.parametrize("steps", [1, 5, 10])
    def test_sampling_with_the_true_velocity(self, x, steps):
        """Where all labels are one q, the velocity is known, and q comes out."""
        q = jnp.linspace(-1.0, 1.0, 6)

        class Known(Diffusion):
            def velocity(self, q_t, x, t):
                share, noise_share = schedule(t)
                noise = (q_t - share * q) / noise_share
                return share * noise - noise_share * q

        model = Known(6, jax.random.key(SEED), steps)
        out = model.outputs(x, jax.random.key(SEED), 4)
        assert out.shape == (5, 4, 6)
        assert np.abs(out - q).max() < 1e-5

    def test_steps_of_the_paper(self):
        for robot, steps in (("cvr038", 5), ("cvrb1213", 10)):
            assert models.make_model(robot, "diffusion", 6, SEED).steps == steps


class TestWeights:
    def facts(self, name):
        return models.Facts("cvr038", name, 1.5, 100, 32, 1000, SEED, 0)

    @pytest.mark.parametrize("name", plan.MODELS)
    def test_read_as_written(self, tmp_path, x, name):
        model = models.make_model("cvr038", name, 6, SEED)
        scaling = data.Scaling(np.zeros(12), np.ones(12), np.arange(6.0), np.ones(6))
        facts = self.facts(name)
        models.save_weights(tmp_path / "a.npz", model, scaling, facts)
        read, scaling_read, facts_read = models.load_weights(tmp_path / "a.npz")
        assert facts_read == facts
        assert np.array_equal(scaling_read.q_mean, scaling.q_mean)
        key = jax.random.key(0)
        before, after = (m.outputs(x, key, 2) for m in (model, read))
        assert np.abs(before - after).max() < 0.02
        models.save_weights(tmp_path / "b.npz", read, scaling, facts)
        again, *_ = models.load_weights(tmp_path / "b.npz")
        assert np.array_equal(again.outputs(x, key, 2), after)

    @pytest.mark.parametrize("name", plan.MODELS)
    def test_of_other_inputs(self, tmp_path, name):
        few = data.QUATERNION_FEATURES
        model = models.make_model("cvr038", name, 6, SEED, features=few)
        scaling = data.Scaling(np.zeros(few), np.ones(few), np.zeros(6), np.ones(6))
        models.save_weights(tmp_path / "a.npz", model, scaling, self.facts(name))
        read, *_ = models.load_weights(tmp_path / "a.npz")
        x = jax.random.normal(jax.random.key(SEED), (5, few))
        outputs = [m.outputs(x, jax.random.key(0), 2) for m in (model, read)]
        assert np.abs(outputs[0] - outputs[1]).max() < 0.02

    def test_of_another_architecture(self, tmp_path):
        scaling = data.Scaling(np.zeros(12), np.ones(12), np.zeros(6), np.ones(6))
        model = models.make_model("cvr038", "mdn", 6, SEED)
        path = tmp_path / "a.npz"
        models.save_weights(path, model, scaling, replace(self.facts("flow"), seed=1))
        with pytest.raises(ValueError, match=r"a\.npz has 241800 weights, not 895874"):
            models.load_weights(path)


class TestTraining:
    @pytest.fixture(autouse=True)
    def small(self, tmp_path, monkeypatch):
        monkeypatch.setattr(data, "WORK", tmp_path)
        monkeypatch.setattr(train, "WORK", tmp_path)
        monkeypatch.setattr(train, "BATCH", 32)
        monkeypatch.setattr(train, "CURVE", 20)

    def training(self, total):
        training = train.begin_training("cvr038", "mdn", SEED, 1_000)
        training.total = total
        return training

    def test_goes_on_to_the_last_bit(self, tmp_path):
        whole = self.training(300)
        losses = [whole.advance() for _ in range(3)]
        assert losses[2] < losses[1] < losses[0]
        part = self.training(300)
        part.advance()
        part.point(1.0)
        part.save(tmp_path / "part.npz")
        rest = self.training(0)
        rest.load(tmp_path / "part.npz")
        assert (rest.step, rest.total, rest.curve) == (100, 300, part.curve)
        assert rest.seconds == part.seconds > 0.0
        assert [rest.advance(), rest.advance()] == losses[1:]
        for a, b in zip(*map(jax.tree.leaves, (whole.state, rest.state)), strict=True):
            if eqx.is_array(a):
                assert np.array_equal(a, b)

    def test_command_writes_weights_and_curve(self, tmp_path, monkeypatch):
        monkeypatch.setattr(plan, "WEIGHTS", tmp_path)
        first = train.train("cvr038", "mdn", 1e-3, SEED, samples=1_000)
        assert first.steps == train.STEPS_A_CALL
        longer = train.train("cvr038", "mdn", 0.02, SEED, samples=1_000)
        assert longer.steps > first.steps
        _, _, facts = models.load_weights(tmp_path / "cvr038_mdn.npz")
        assert facts == longer
        curve = evaluate.read_curve(tmp_path / "cvr038_mdn.csv")
        assert [point["steps"] for point in curve][:: len(curve) - 1] == [
            first.steps,
            longer.steps,
        ]

    def test_other_labels_leave_the_committed_weights(self, tmp_path, monkeypatch):
        monkeypatch.setattr(plan, "WEIGHTS", tmp_path / "committed")
        monkeypatch.setattr(plan, "WORK", tmp_path)
        other = plan.Recipe("drawn", "rotation")
        train.train("cvr038", "mdn", 1e-3, SEED, samples=500, recipe=other)
        assert (tmp_path / "learned" / "cvr038_mdn_drawn_rotation.npz").exists()
        assert not (tmp_path / "committed").exists()

    def test_rate(self):
        total = jnp.asarray(10_000)
        rates = [float(train.rate(jnp.asarray(i), total)) for i in range(0, 10_001, 50)]
        assert rates[0] < 0.01 * train.PEAK_RATE
        assert max(rates) == pytest.approx(train.PEAK_RATE, rel=0.02)
        assert rates[-1] == pytest.approx(0.0, abs=1e-9)


class TestEvaluation:
    def test_one_attempt_from_the_seed_alone(self):
        arm = load_arm("cvr038")
        solver = evaluate.paper_solver("cvr038")
        q = arm.robot.random_configurations(20, SEED)
        poses = arm.robot.fk(q)
        for pose, near, far in zip(poses, q, q[::-1], strict=True):
            good = evaluate.from_seed(solver, pose, near)
            assert (good.success, good.attempts) == (True, 1)
            assert good.q == pytest.approx(near, abs=1e-3)
            assert evaluate.from_seed(solver, pose, far).attempts == 1
        wrong = evaluate.solved(solver, poses, q[::-1])
        assert wrong.sum() < 10 < solver.solve_batch(poses).solved

    def test_distance(self):
        a = np.eye(4)
        b = iksel.pose_from_quaternion([0.3, 0.0, 0.4], [0.0, 0.0, 1.0, 0.0])
        quaternions = np.sqrt(2.0)  # between (1, 0, 0, 0) and one at right angles
        assert evaluate.distances(a, b) == pytest.approx(np.hypot(0.5, quaternions))
        c = iksel.pose_from_quaternion([0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0])
        assert evaluate.distances(a, c) == pytest.approx(0.0, abs=1e-12)

    def test_best(self):
        robot = load_arm("ur3_wrs").robot
        q = robot.random_configurations(8, SEED)
        for i, pose in enumerate(robot.fk(q)):
            assert evaluate.best(robot, q, pose) == i

    def test_best_is_judged_inside_the_limits(self):
        robot = load_arm("cvr038").robot
        q = robot.random_configurations(1, SEED)[0]
        turned = q + 2.0 * np.pi * np.eye(6)[0]  # outside, though at the pose
        pair = np.stack([turned, q + 0.01])
        assert evaluate.best(robot, pair, robot.fk(q)) == 1

    @pytest.mark.parametrize("robot", ["cvr038", "cvrb1213"])
    def test_configurations_are_all_that_reach(self, robot):
        """Beside all turns of each joint of every branch, each counted once."""
        arm = load_arm(robot)
        solver = iksel.Solver(arm.robot)
        poses = arm.robot.fk(arm.robot.random_configurations(20, SEED))
        turns = 2.0 * np.pi * np.array(list(itertools.product([-1, 0, 1], repeat=6)))
        counts = []
        for pose in poses:
            every = (solver.solve_all(pose).q[:, None] + turns).reshape(-1, 6)
            inside = every[arm.chain.within_limits(every)]
            counts.append(len(np.unique(inside.round(3), axis=0)))
        assert evaluate.configurations(arm, poses) == pytest.approx(np.mean(counts))

    def test_errors(self):
        arm = load_arm("cvr038")
        q = arm.robot.random_configurations(40, SEED).reshape(10, 4, 6)
        poses = arm.robot.fk(q[:, 2])
        figures = batch_errors(arm, poses, q)["position_mm"]
        position = np.linalg.norm(
            arm.chain.fk(q.reshape(-1, 6))[:, :3, 3].reshape(10, 4, 3)
            - poses[:, None, :3, 3],
            axis=-1,
        )
        assert figures["min"] == pytest.approx(0.0, abs=1e-6)
        assert figures["max"] == pytest.approx(1e3 * position.max(axis=1).mean())
        assert figures["deviation"] == pytest.approx(1e3 * position.mean(axis=1).std())
        assert figures["first"][0] == pytest.approx(1e3 * position[:, 0].min())
        assert figures["first"][2] == pytest.approx(1e3 * np.median(position[:, 0]))
        assert figures["first"][-1] == pytest.approx(1e3 * position[:, 0].max())

    def test_why(self):
        arm = load_arm("cvr038")
        q = arm.robot.random_configurations(100, SEED)
        poses = arm.robot.fk(q)
        label = data.labels(arm, poses)
        far = np.roll(q, 1, axis=0)
        shares = evaluate.why(arm, poses, np.stack([far, label, far[::-1]], axis=1))
        assert 0.0 < shares.pop("jumps") < 20.0
        assert shares.pop("beside_label") > 90.0
        assert set(shares.values()) == {100.0}
        shares = evaluate.why(arm, poses, np.stack([far, far[::-1]], axis=1))
        assert shares["ranked"] <= shares["any"] < 50.0


@pytest.mark.skipif(
    not plan.WEIGHTS.exists(), reason="weights are in the repository only"
)
class TestCommitted:
    def test_all_are_there_and_small(self):
        paths = {plan.weights_path(*each) for each in REPORTED}
        assert set(plan.WEIGHTS.glob("*.npz")) == paths
        assert sum(path.stat().st_size for path in paths) < MANY

    @pytest.mark.parametrize(
        ("robot", "model", "recipe"),
        [pytest.param(*each, id=plan.name_of(*each)) for each in REPORTED],
    )
    def test_are_what_their_names_say(self, robot, model, recipe):
        path = plan.weights_path(robot, model, recipe)
        _, scaling, facts = models.load_weights(path)
        count = {"rotation": data.FEATURES, "quaternion": data.QUATERNION_FEATURES}
        assert len(scaling.x_mean) == count[recipe.inputs]
        assert (facts.robot, facts.model) == (robot, model)
        assert len(scaling.q_mean) == load_arm(robot).chain.dof
        curve = evaluate.read_curve(path.with_suffix(".csv"))
        assert curve[-1]["steps"] == facts.steps
        assert curve[-1]["minutes"] == facts.minutes > 0.5

    def test_are_worth_what_is_said(self):
        model, scaling, _ = models.load_weights(plan.weights_path("cvr038", "mdn"))
        solved = evaluate.seeds_solved("cvr038", model, scaling, SEED, 500)
        assert solved["first"] > 83.0

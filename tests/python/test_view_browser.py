# SPDX-License-Identifier: BSD-3-Clause
"""The viewer in headless Chromium, driven by the mouse.

scripts/bootstrap.sh --browser installs what it needs: the extra iksel[browser], and a
Chromium in the path.
"""

from __future__ import annotations

import time

import numpy as np
import pytest
from test_view import free_port

from iksel import view

pytest.importorskip("viser", reason="pip install iksel[view]")
playwright = pytest.importorskip(
    "playwright.sync_api", reason="pip install iksel[browser]"
)
from view_page import WITHOUT_GPU, Page, find_chromium  # noqa: E402 (an extra)

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as engine:
        chromium = find_chromium(engine)
        if chromium is None:
            pytest.skip("no Chromium: scripts/bootstrap.sh --browser")
        browser = engine.chromium.launch(executable_path=chromium, args=WITHOUT_GPU)
        yield browser
        browser.close()


@pytest.fixture
def page(made, browser):
    with view.Viewer(made.solver("ur5e"), port=free_port()) as viewer:
        page = Page(browser, viewer)
        yield page
        page.page.close()
    assert page.errors == []


def test_the_target_is_dragged_by_the_mouse(page, tmp_path):
    session = page.viewer.session
    robot = session.robot
    before, q = session.target.copy(), session.q.copy()
    axis, start, along = page.handle()
    page.drag([start + 4 * i * along for i in range(5)])
    moved = session.target[:3, 3] - before[:3, 3]
    assert np.linalg.norm(moved) > 0.01
    aligned = abs(moved @ before[:3, axis]) / np.linalg.norm(moved)
    assert aligned == pytest.approx(1, abs=1e-3)
    assert session.solved
    assert np.abs(session.q - q).max() > 1e-3
    np.testing.assert_allclose(robot.fk(session.q), session.target, atol=2e-6)
    assert page.page.get_by_text("solved").is_visible()
    image = page.page.screenshot(path=tmp_path / "view.png")
    assert len(image) > 20_000


def test_the_reason_why_there_is_no_answer_is_shown(page):
    _, start, along = page.handle()
    page.drag([start + 60 * i * along for i in range(12)])
    page.page.wait_for_selector("text=no answer", timeout=20_000)
    assert not page.viewer.session.solved
    assert page.page.get_by_text("out_of_reach, proven").is_visible()


def test_the_robot_follows_within_100_ms(page):
    """From a target that leaves the page until the page has the robot at it."""
    _, start, along = page.handle()
    steps = np.concatenate([np.linspace(0, 20, 30), np.linspace(20, 0, 30)])
    page.drag(start + steps[:, None] * along, pause=100)
    there, drawn = page.delays()
    assert len(there) > 30
    assert page.viewer.session.solved
    shares = (0, 50, 90, 99, 100)
    for what, delays in (("there", there), ("drawn", drawn)):
        ms = np.percentile(delays, shares, method="nearest").round(1)
        by_share = ", ".join(f"{s} %: {x}" for s, x in zip(shares, ms, strict=True))
        print(f"{what}, {len(delays)} targets, [ms]: {by_share}")  # noqa: T201 (-rP)
    assert np.median(there) < 100


def test_what_is_switched_on_in_the_browser_is_shown(page):
    viewer = page.viewer
    page.page.get_by_label("all branches").click()
    deadline = time.monotonic() + 10
    while viewer.scene.ghosts == 0 and time.monotonic() < deadline:
        page.page.wait_for_timeout(50)
    expected = len(viewer.session.solver.solve_all(viewer.session.target))
    assert viewer.scene.ghosts == expected > 1
    page.page.wait_for_selector(f"text=solutions: {expected}", timeout=20_000)

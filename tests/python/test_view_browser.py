# SPDX-License-Identifier: BSD-3-Clause
"""The viewer in headless Chromium, driven by the mouse.

Needs the extra iksel[browser], and a chromium or chromium-headless-shell in the path.
"""

from __future__ import annotations

import shutil
import time

import numpy as np
import pytest
from test_view import free_port

import iksel
from iksel import view
from iksel.view.scene import TARGET

pytest.importorskip("viser", reason="pip install iksel[view]")
playwright = pytest.importorskip(
    "playwright.sync_api", reason="pip install iksel[browser]"
)
CHROMIUM = shutil.which("chromium-headless-shell") or shutil.which("chromium")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="no chromium in the path"),
]
WIDTH, HEIGHT = 800, 600
WITHOUT_GPU = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


class Page:
    """A viewer's page, with what went wrong on it."""

    def __init__(self, browser, viewer):
        self.viewer = viewer
        self.errors = []
        self.page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on(
            "console",
            lambda m: self.errors.append(m.text) if m.type == "error" else None,
        )
        self.page.goto(viewer.url)
        self.page.wait_for_selector("text=stay near")
        self.page.wait_for_timeout(3000)  # until shaders are compiled

    def pixel(self, point) -> np.ndarray:
        """Where a point of the base frame is on the page."""
        (client,) = self.viewer._server.get_clients().values()
        camera = client.camera
        pose = iksel.pose_from_quaternion(camera.position, camera.wxyz)
        x, y, z = (np.linalg.inv(pose) @ np.append(point, 1))[:3]
        scale = HEIGHT / 2 / np.tan(camera.fov / 2)
        return np.array([WIDTH / 2 + scale * x / z, HEIGHT / 2 + scale * y / z])

    def drag(self, pixels) -> None:
        """Press the mouse at the first of pixels (n, 2), and move it to the others."""
        self.page.mouse.move(*pixels[0])
        self.page.wait_for_timeout(500)
        self.page.mouse.down()
        self.page.wait_for_timeout(300)
        for pixel in pixels[1:]:
            self.page.mouse.move(*pixel)
            self.page.wait_for_timeout(50)


@pytest.fixture
def page(made):
    with (
        view.Viewer(made.solver("ur5e"), port=free_port()) as viewer,
        playwright.sync_playwright() as engine,
    ):
        browser = engine.chromium.launch(executable_path=CHROMIUM, args=WITHOUT_GPU)
        yield Page(browser, viewer)
        browser.close()


def test_the_target_is_dragged_by_the_mouse(page, tmp_path):
    session = page.viewer.session
    robot = session.robot
    before, q = session.target.copy(), session.q.copy()
    # By the arrow of the target's axis that is seen from the side, inwards, then out.
    hands = [before[:3, 3] + 0.8 * TARGET * robot.reach * a for a in before[:3, :3].T]
    centre = page.pixel(before[:3, 3])
    lengths = [np.linalg.norm(page.pixel(hand) - centre) for hand in hands]
    axis = int(np.argmax(lengths))
    start = page.pixel(hands[axis])
    along = (start - centre) / np.linalg.norm(start - centre)
    page.drag([start + 4 * i * along for i in range(5)])
    page.page.mouse.up()
    page.page.wait_for_timeout(1000)
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
    start = page.pixel(session.target[:3, 3] + hands[axis] - before[:3, 3])
    page.drag([start + 60 * i * along for i in range(12)])
    page.page.mouse.up()
    page.page.wait_for_selector("text=no answer", timeout=20_000)
    assert not session.solved
    assert page.page.get_by_text("out_of_reach, proven").is_visible()
    assert page.errors == []


def test_what_is_switched_on_in_the_browser_is_shown(page):
    viewer = page.viewer
    page.page.get_by_label("all branches").click()
    deadline = time.monotonic() + 10
    while viewer.scene.ghosts == 0 and time.monotonic() < deadline:
        page.page.wait_for_timeout(50)
    expected = len(viewer.session.solver.solve_all(viewer.session.target))
    assert viewer.scene.ghosts == expected > 1
    page.page.wait_for_selector(f"text=solutions: {expected}", timeout=20_000)
    assert page.errors == []

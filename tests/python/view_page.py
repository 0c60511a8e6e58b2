# SPDX-License-Identifier: BSD-3-Clause
"""A viewer's page in headless Chromium, and when it sends targets and gets answers."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

import iksel
from iksel.view.scene import TARGET

WIDTH, HEIGHT = 800, 600
NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
WITHOUT_GPU = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")

# viser's page talks to the server through a worker. What passes between the two is
# kept with the page's time [ms]: targets that leave, with where they are [m], and where
# the robot's last frame, the TCP, comes to be; of the latter also when that is drawn.
LISTEN = """
(() => {
  const log = window.viewLog = {targets: [], tips: []};
  const Plain = window.Worker;
  window.Worker = class extends Plain {
    constructor(...given) {
      super(...given);
      this.addEventListener('message', ({data}) => {
        if (data.type !== 'message_batch') return;
        for (const message of data.messages) {
          const balls = message.updates?.batched_positions;
          if (message.name !== '/robot/frames' || !balls) continue;
          const tip = {at: performance.now(), place: [...balls.slice(-3)]};
          log.tips.push(tip);
          requestAnimationFrame(() => setTimeout(() => tip.drawn = performance.now()));
        }
      });
    }
    postMessage(data, ...more) {
      if (data.message?.type === 'TransformControlsUpdateMessage')
        log.targets.push({at: performance.now(), place: data.message.position});
      return super.postMessage(data, ...more);
    }
  };
})();
"""


def find_chromium(engine) -> str | None:
    """A Chromium of the system, or playwright's own."""
    found = next(filter(None, map(shutil.which, NAMES)), None)
    own = engine.chromium.executable_path
    return found or (own if Path(own).exists() else None)


class Page:
    """A viewer's page, with what went wrong on it."""

    def __init__(self, browser, viewer) -> None:
        self.viewer = viewer
        self.errors: list[str] = []
        self.page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        self.page.add_init_script(LISTEN)
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.on(
            "console",
            lambda m: self.errors.append(m.text) if m.type == "error" else None,
        )
        self.page.goto(viewer.url)
        self.page.wait_for_selector("text=all branches")
        self.page.wait_for_timeout(3000)  # until shaders are compiled

    def pixel(self, point) -> np.ndarray:
        """Where a point of the base frame is on the page."""
        (client,) = self.viewer._server.get_clients().values()
        camera = client.camera
        pose = iksel.pose_from_quaternion(camera.position, camera.wxyz)
        x, y, z = (np.linalg.inv(pose) @ np.append(point, 1))[:3]
        canvas = self.page.locator("canvas").first.bounding_box()
        scale = canvas["height"] / 2 / np.tan(camera.fov / 2)
        middle = [
            canvas[a] + canvas[b] / 2 for a, b in (("x", "width"), ("y", "height"))
        ]
        return np.array(middle) + scale / z * np.array([x, y])

    def handle(self) -> tuple[int, np.ndarray, np.ndarray]:
        """The target's arrow that is seen from the side.

        Returns:
            Which axis of the target it is, the pixel to take it by, and the direction
            along it on the page.
        """
        target = self.viewer.session.target
        reach = self.viewer.session.robot.reach
        centre = self.pixel(target[:3, 3])
        hands = [
            self.pixel(target[:3, 3] + 0.8 * TARGET * reach * axis)
            for axis in target[:3, :3].T
        ]
        axis = int(np.argmax([np.linalg.norm(hand - centre) for hand in hands]))
        along = hands[axis] - centre
        return axis, hands[axis], along / np.linalg.norm(along)

    def drag(self, pixels, pause: float = 50) -> None:
        """Press the mouse at the first of pixels (n, 2), and move it to the others."""
        self.page.mouse.move(*pixels[0])
        self.page.wait_for_timeout(500)
        self.page.mouse.down()
        self.page.wait_for_timeout(300)
        for pixel in pixels[1:]:
            self.page.mouse.move(*pixel)
            self.page.wait_for_timeout(pause)
        self.page.mouse.up()
        self.page.wait_for_timeout(1000)

    def delays(self) -> tuple[np.ndarray, np.ndarray]:
        """From each target that left until the TCP was there, and until that was drawn.

        Returns:
            Two of (n,) [ms]; infinite where the TCP never came to be.
        """
        log = self.page.evaluate("viewLog")
        rows = []
        for target in log["targets"]:
            near = (
                tip
                for tip in log["tips"]
                if tip["at"] > target["at"]
                and np.allclose(tip["place"], target["place"], rtol=0, atol=1e-5)
            )
            tip = next(near, {})
            at = [tip.get(key, np.inf) for key in ("at", "drawn")]
            rows.append(np.array(at) - target["at"])
        return tuple(np.array(rows).reshape(-1, 2).T)

# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of maps: slices, and the capability map as spheres."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError

from iksel._base.figures import COLOURS, SIZE, make_figure, save_figure
from iksel.reach._errors import MapIoError, need

if TYPE_CHECKING:
    from collections.abc import Sequence

    from iksel._base.arrays import FloatArray
    from iksel.reach._location import StrPath
    from iksel.reach._map import Map
    from iksel.reach._place import Placement

MOST_SPHERES = 20_000
ARROW = 0.1  # [m]


def draw_slice(
    reach_map: Map,
    path: StrPath,
    *,
    axis: str = "y",
    at: float = 0.0,
    spacing: float | None = None,
) -> None:
    """Draw the share of orientations over a plane; the file's suffix says the format.

    Args:
        reach_map: The map.
        path: File to write: .png, .svg or .pdf.
        axis: "x", "y" or "z", which stands upright on the plane.
        at: Where on that axis [m].
        spacing: Distance of the samples [m]; None: the map's.

    Raises:
        InvalidArgumentError: No such axis.
        MapIoError: The file cannot be written.
    """
    across, along, shares = reach_map.slice(axis, at, spacing)
    figure = _figure()
    axes = figure.add_subplot()
    image = axes.pcolormesh(
        across, along, shares.T, cmap=COLOURS, vmin=0, vmax=1, shading="nearest"
    )
    first, second = (name for name in "xyz" if name != axis)
    axes.set(
        xlabel=f"{first} [m]",
        ylabel=f"{second} [m]",
        aspect="equal",
        title=f"{reach_map.robot.name}: {axis} = {at:g} m",
    )
    figure.colorbar(image, label="share of orientations reached")
    _save(figure, path)


def draw_spheres(
    reach_map: Map,
    path: StrPath,
    *,
    spacing: float | None = None,
    cut: bool = True,
) -> None:
    """Draw the capability map: a sphere for each position, coloured by its share.

    Zacharias et al., "Capturing Robot Workspace Structure" (IROS 2007).

    Args:
        reach_map: The map.
        path: File to write: .png, .svg or .pdf.
        spacing: Distance of the spheres [m]; None: the map's, or coarser where that
            would be more than 20,000.
        cut: Leave out y < 0, to see inside.

    Raises:
        MapIoError: The file cannot be written.
    """
    points, shares, step = reached_places(reach_map, spacing, cut=cut)
    figure = _figure()
    axes = figure.add_subplot(projection="3d")
    drawn = axes.scatter(
        *points.T,
        c=shares,
        cmap=COLOURS,
        vmin=0,
        vmax=1,
        s=_area(step, reach_map.axes(step)[0]),
    )
    axes.set(xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", title=reach_map.robot.name)
    axes.set_aspect("equal")
    axes.view_init(elev=20, azim=-70)
    figure.colorbar(drawn, label="share of orientations reached", shrink=0.7)
    _save(figure, path)


def reached_places(
    reach_map: Map, spacing: float | None = None, *, cut: bool
) -> tuple[FloatArray, FloatArray, float]:
    """Positions that are reached at all, as draw_spheres() shows them.

    Args:
        reach_map: The map.
        spacing: Distance of the positions [m]; None: the map's, or coarser where that
            would be more than 20,000.
        cut: Leave out y < 0.

    Returns:
        Positions in the base frame (n, 3) [m], their shares of orientations (n,), and
        the distance between neighbours [m].
    """
    step = reach_map.grid.positions.spacing if spacing is None else spacing
    while True:
        axes, shares = reach_map.box(step)
        shown = shares > 0
        if cut:
            shown &= (axes[1] >= 0)[None, :, None]
        if spacing is not None or shown.sum() <= MOST_SPHERES:
            break
        step *= 1.25
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    return places[shown], shares[shown], step


def draw_placements(
    placements: Sequence[Placement], poses: np.ndarray[Any, Any], path: StrPath
) -> None:
    """Draw bases and the poses of the tool that they reach, from above.

    Args:
        placements: What place_base() gave, the best first.
        poses: T_world_tcp, (n, 4, 4).
        path: File to write: .png, .svg or .pdf.

    Raises:
        MapIoError: The file cannot be written.
    """
    figure = _figure()
    axes = figure.add_subplot()
    best = placements[0]
    reached = best.reachable
    for mask, colour, label in (
        (reached, "tab:green", "reached from the best"),
        (~reached, "tab:red", "not reached"),
    ):
        if mask.any():
            tips = poses[mask]
            ends = tips[:, :2, 3] + ARROW * tips[:, :2, 2]
            axes.update_datalim(np.concatenate([tips[:, :2, 3], ends]))
            axes.quiver(
                *tips[:, :2, 3].T,
                *tips[:, :2, 2].T,
                color=colour,
                label=label,
                width=4e-3,
                angles="xy",
                scale_units="xy",
                scale=1 / ARROW,
            )
    others = np.array([p.T_world_base[:2, 3] for p in placements])
    counts = [p.reached for p in placements]
    points = axes.scatter(*others.T, c=counts, cmap=COLOURS, label="bases")
    axes.plot(*others[0], "k+", markersize=14, label="the best")
    axes.set(
        xlabel="x [m]",
        ylabel="y [m]",
        aspect="equal",
        title=f"{best.reached} of {len(poses)} poses reached",
    )
    axes.margins(0.1)
    axes.autoscale_view()
    figure.legend(loc="outside lower center", ncols=4)
    figure.colorbar(points, label="poses reached")
    _save(figure, path)


def _figure() -> Any:
    need("matplotlib")
    return make_figure()


def _area(step: float, x: np.ndarray[Any, Any]) -> float:
    """Area of a marker as large as a cell, about [point^2]."""
    return float((0.45 * SIZE[0] * 72 * step / max(np.ptp(x), step)) ** 2)


def _save(figure: Any, path: StrPath) -> None:
    try:
        save_figure(figure, path)
    except InvalidArgumentError as error:
        raise MapIoError(str(error)) from error

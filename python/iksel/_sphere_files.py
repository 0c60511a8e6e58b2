# SPDX-License-Identifier: BSD-3-Clause
"""Files of spheres that other tools write."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from iksel_cpp import InvalidArgumentError

from iksel import _safe_yaml
from iksel._files import check_regular, read_text

if TYPE_CHECKING:
    from pathlib import Path

    from iksel._arrays import FloatArray


def read_yaml(path: Path) -> dict[str, Any]:
    """The mapping that a YAML file holds.

    Raises:
        InvalidArgumentError: It cannot be read, or is none.
    """
    try:
        check_regular(path)
        data = _safe_yaml.load(read_text(path))
    except ImportError as error:
        raise InvalidArgumentError(
            f"path: YAML needs PyYAML, which cannot be imported ({error}); install "
            "it by: pip install pyyaml"
        ) from None
    except (OSError, ValueError) as error:
        raise InvalidArgumentError(f"path: {error}") from None
    if not isinstance(data, dict):
        raise InvalidArgumentError(f"path: {str(path)!r} is no mapping")
    return data


def read_links(
    path: Path, data: dict[str, Any], centre: str, buffer: float
) -> dict[str, FloatArray]:
    """Spheres by link; those whose radius is not above 0 are none."""
    links = {}
    for link, spheres in data.items():
        rows = []
        for sphere in spheres if isinstance(spheres, list) else [spheres]:
            try:
                place = sphere.get(centre, sphere.get("center"))
                row = np.array([*place, sphere["radius"]], dtype=float)
            except (AttributeError, KeyError, TypeError, ValueError):
                row = np.empty(0)
            if row.shape != (4,):
                shown = str(sphere)[:80]
                raise InvalidArgumentError(
                    f"path: {str(path)!r}: link {link!r} has {shown!r}, expected "
                    f"{centre} (3 numbers) and radius"
                )
            if row[3] > 0:
                rows.append([*row[:3], row[3] + buffer])
        if rows:
            links[str(link)] = np.array(rows)
    return links

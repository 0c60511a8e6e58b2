# SPDX-License-Identifier: BSD-3-Clause
"""Why the extension module cannot be imported, and what to do about it."""

from __future__ import annotations

import re

# Packages of Debian and Ubuntu, by the beginning of the names of their libraries; the
# first that fits counts. Those for development are named alike in every release.
_PACKAGES = {
    "liborocos-kdl": "liborocos-kdl-dev",
    "liburdfdom": "liburdfdom-dev",
    "libconsole_bridge": "libconsole-bridge-dev",
    "libtinyxml2": "libtinyxml2-dev",
    "libtinyxml": "libtinyxml-dev",
    "libstdc++": "libstdc++6",
    "libgcc_s": "libgcc-s1",
}


def explain(message: str) -> str:
    """What to say in the place of the loader's message."""
    if "subinterpreter" in message:
        return message
    missing = re.search(r"\b(lib[\w+-]+)\.so[.\d]*", message)
    if missing is None or missing[1] == "libiksel":
        return (
            "iksel needs its compiled extension module iksel_cpp, which could not be "
            f"imported ({message}). Install the package ('pip install .' at the top of "
            "the repository) for this Python; the source tree alone is not enough."
        )
    library = missing.group()
    packages = (p for start, p in _PACKAGES.items() if library.startswith(start))
    package = next(packages, None)
    how = (
        f"install it, on Debian or Ubuntu by 'apt-get install {package}'"
        if package
        else "install the package that has it ('apt-file search' finds its name)"
    )
    return (
        f"iksel needs the shared library {library}, which could not be loaded "
        f"({message}): {how}. If it is still not found, iksel was built for another "
        "release of it: install iksel again ('pip install .' at the top of the "
        "repository)."
    )

# SPDX-License-Identifier: BSD-3-Clause
"""How Sphinx makes the site; scripts/docs.sh runs it."""

import os
import re
from pathlib import Path

from sphinx.ext.napoleon import Config, GoogleDocstring

import iksel

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build" / "docs"

project = "IKSel"
author = "the IKSel authors"
version = release = iksel.__version__

extensions = [
    "breathe",
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "sphinx_design",
]
html_theme = "furo"
html_title = f"IKSel {release}"
html_static_path = ["_static"]
html_css_files = ["iksel.css"]
html_copy_source = False
html_show_copyright = False
# What is copied is what is typed.
copybutton_prompt_text = "$ "

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4

# Every page that is a notebook runs, and the first error ends the build.
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 120
# What they write is not written beside them.
nb_execution_in_temp = True
os.environ["MATPLOTLIBRC"] = str(ROOT / "docs" / "matplotlibrc")
nb_merge_streams = True

# C++: what Doxygen read from the public headers.
breathe_projects = {"iksel": str(BUILD / "doxygen" / "xml")}
breathe_default_project = "iksel"
breathe_show_include = False

# Python: docstrings, in the style of Google; a class's own and its constructor's.
autoclass_content = "both"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
maximum_signature_line_length = 88
# A name in single backticks is code.
default_role = "code"

# Each header declares its part of namespace iksel.
suppress_warnings = ["duplicate_declaration.cpp"]

# Types of other projects have no page here, nor has what is private.
nitpick_ignore_regex = [
    (r"cpp:identifier", r"(std|Eigen|iksel::export)(::.*)?|size_t|u?int\d+_t"),
    (
        r"cpp:identifier",
        r"ChainModel|Data|DatabaseData|Impl|Names|StoredPose::Identity|RobotModel|TipsModel",
    ),
    (r"py:.*", r"(collections|enum|np|npt|numpy|os|pathlib|types|typing)\..*"),
    (r"py:class", r"ArrayLike|Any|Callable|Filter|Float|Int|Literal|Mapping|Sequence"),
    (r"py:class", r"iksel(\.\w+)*\._.*|(Bool|Float|Int)Array|Arrays|Origin|Packages"),
    (r"py:class", r"Placed|PoseLike|QuaternionOrder|Source|StrPath"),
    (r"py:exc", r"NoCMakeFilesError"),
]


# What a signature of pybind11 says in other words.
SHORTER = (
    (r"^\(self: [\w.]+(, )?", "("),
    (r"\biksel_cpp\.", "iksel."),
    (r"\b(collections\.abc|numpy\.typing|typing)\.", ""),
    (r"NDArray\[numpy\.\w+\]", "numpy.ndarray"),
    (r"\bArrayLike \| object", "ArrayLike"),
    (r"\bSupports(Int|Float) \| SupportsIndex", r"\1"),
)


def plain(text):
    """A signature, or a part of one, as users write it."""
    for found, written in SHORTER:
        text = text and re.sub(found, written, text)
    return text


def plain_signature(app, what, name, obj, options, signature, returns):
    """Name classes as users do, and leave out what does not help a reader."""
    return plain(signature), plain(returns)


def plain_docstring(app, what, name, obj, options, lines):
    """Read Google's style; bars are no markup, a property's colon is no type."""
    lines[:] = [re.sub(r"\||(?<=\S)\*(?=\S)", r"\\\g<0>", line) for line in lines]
    if isinstance(obj, property):
        # pybind11 keeps the type with the getter.
        _, arrow, type_ = (obj.fget.__doc__ or "").rpartition(" -> ")
        if arrow and lines:
            lines[0] = f"``{plain(type_.strip())}``: {lines[0]}"
    elif what not in {"attribute", "data"}:
        style = Config(napoleon_use_rtype=False)
        google = GoogleDocstring(lines, style, app, what, name, obj, options)
        lines[:] = google.lines()


def setup(app):
    """Connect what is above."""
    app.connect("autodoc-process-signature", plain_signature)
    app.connect("autodoc-process-docstring", plain_docstring)

# SPDX-License-Identifier: BSD-3-Clause
"""What Python's docs say is what the core's headers say, in words of Python."""

from __future__ import annotations

import re
from pathlib import Path

import iksel_cpp
import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts"
SOURCE = """
namespace iksel {
enum class Sort { a, b };
/// A thing. Throws nothing.
struct IKSEL_EXPORT Thing : Base {
  enum class Colour { red, blue };  ///< not read
  struct Part { int x = 1; };
  Sort kind = Sort::a;
  /// Lower and upper [m]; empty: none.
  double lower = 0;
  double upper{1};

  double apart = 2;
  std::optional<JointVector> q;  ///< joint values [rad or m], as Thing::other
                                 ///< has them
  std::map<std::string, double> a = {}, b;  // not read either
  /// Whether it is.
  [[nodiscard]] bool is(const Thing& thing = {}) const { return thing.lower < 1; }
  Thing& operator=(const Thing&) = delete;
};
class Closed {
  int hidden = 0;
 public:
  /// What it has.
  [[nodiscard]] const std::map<int, double>& has(
      std::function<double(int)> of = {}) const;
 private:
  /// Hidden too.
  int more() { return hidden; }
};
/// A function.
IKSEL_EXPORT int count(const Thing& thing);
}  // namespace iksel
"""


@pytest.fixture
def headers(monkeypatch):
    """What is read of SOURCE."""
    if not SCRIPTS.is_dir():
        pytest.skip("scripts/ is in the repository only")
    monkeypatch.syspath_prepend(str(SCRIPTS))
    tables = pytest.importorskip("header_tables")
    read = tables.Headers()
    tables.Reader(read).read(SOURCE)
    return read


def test_members_are_found_in_their_order(headers) -> None:
    thing, closed = headers.structs
    assert (thing.kind, thing.name, thing.base) == ("struct", "Thing", "Base")
    assert thing.fields == ["kind", "lower", "upper", "apart", "q", "a", "b"]
    assert (closed.kind, closed.name, closed.fields) == ("class", "Closed", [])


def test_texts_are_those_of_python(headers) -> None:
    enums = {"Sort": re.match("(?P<text>.*)", "What it is.")}
    texts = {key: headers.text(key, enums) for key in headers.types | headers.texts}
    assert {key: text for key, text in texts.items() if text} == {
        "Thing": "A thing. Raises nothing.",
        "Thing.kind": "What it is.",
        "Thing.lower": "Lower and upper [m]; None: none.",
        "Thing.upper": "Lower and upper [m]; None: none.",
        "Thing.q": "Joint values [rad or m], (dof,), as Thing.other has them.",
        "Thing.is": "Whether it is.",
        "Closed.has": "What it has.",
        "count": "A function.",
    }


def test_docs_have_no_words_of_cpp() -> None:
    words = re.compile(r"::|\bstd\b|\bkM\w+|\b[Tt]hrows?\b|\bnullptr\b|\bt_base\w+")
    seen = 0
    for name, thing in vars(iksel_cpp).items():
        for member, what in (
            ((None, thing), *vars(thing).items())
            if isinstance(thing, type)
            else ((None, thing),)
        ):
            text = getattr(what, "__doc__", None) or ""
            seen += bool(text)
            assert not words.search(text), f"{name}.{member}: {text}"
    assert seen > 300

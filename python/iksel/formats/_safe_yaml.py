# SPDX-License-Identifier: BSD-3-Clause
"""Reads YAML of somebody else: numbers, texts, lists and mappings, and not too many."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

LONGEST_TEXT = 1 << 20  # characters; PyYAML needs 10 s for them
MOST_NODES = 2_000_000  # each as often as its anchor is named


def load(text: str, tags: Mapping[str, Callable[[str], Any]] | None = None) -> Any:
    """What a YAML text holds.

    Args:
        text: The text.
        tags: What makes a value of the text behind a tag; others are refused.

    Raises:
        ImportError: PyYAML is not installed.
        ValueError: The text is no YAML, or would be too much.
    """
    # An optional extra.
    import yaml  # type: ignore[import-untyped, unused-ignore]  # noqa: PLC0415

    class Loader(yaml.SafeLoader):  # type: ignore[misc, unused-ignore]
        """One whose tags are not SafeLoader's, to which other modules add."""

    known = yaml.constructor.SafeConstructor.yaml_constructors
    Loader.yaml_constructors = dict(known)
    for tag, make in (tags or {}).items():

        def construct(loader: Any, node: Any, make: Any = make) -> Any:
            return make(loader.construct_scalar(node))

        Loader.yaml_constructors[tag] = construct
    if len(text) > LONGEST_TEXT:
        msg = f"YAML of more than {LONGEST_TEXT >> 20} MiB"
        raise ValueError(msg)
    loader = Loader(text)
    try:
        node = loader.get_single_node()
        if node is None:
            return None
        _count(yaml, node, {})
        return loader.construct_document(node)
    except yaml.YAMLError as error:
        raise ValueError(" ".join(str(error).split())) from None
    except RecursionError:
        msg = "YAML that is nested too deep"
        raise ValueError(msg) from None
    finally:
        loader.dispose()


def _count(yaml: Any, node: Any, known: dict[int, int]) -> int:
    """Nodes below and with a node, each as often as it is written out."""
    if id(node) in known:
        if known[id(node)] == 0:
            msg = "YAML with a list or mapping that is in itself"
            raise ValueError(msg)
        return known[id(node)]
    known[id(node)] = 0
    total = 1
    if not isinstance(node, yaml.ScalarNode):
        pairs = isinstance(node, yaml.MappingNode)
        parts = [p for pair in node.value for p in pair] if pairs else node.value
        total += sum(_count(yaml, part, known) for part in parts)
    if total > MOST_NODES:
        msg = "YAML whose anchors make too much of it"
        raise ValueError(msg)
    known[id(node)] = total
    return total

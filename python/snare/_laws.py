"""Laws from what pickle has kept of them: functions that pickle finds by name."""

from __future__ import annotations

from typing import Any, Tuple

from snare import _core


def law(state: Tuple[Any, ...]) -> _core.Law:
    """The Law of this state; raises ValueError where it is none."""
    return _core._law_of(state)


def simple_law(state: Tuple[Any, ...]) -> _core.SimpleLaw:
    """The SimpleLaw of this state; raises ValueError where it is none."""
    return _core._simple_law_of(state)

"""What ``progress=`` may be: nothing, a callable that gets the share done, or True for a bar."""

from __future__ import annotations

import importlib
import sys
from typing import Any, Callable, Union

Progress = Union[None, bool, Callable[[float], object]]


class _Bar:
    """A bar on a terminal, through tqdm where it is installed."""

    def __init__(self) -> None:
        self._tqdm: Any = None
        try:
            tqdm = importlib.import_module("tqdm.auto").tqdm
        except ImportError:
            pass
        else:
            self._tqdm = tqdm(total=100, leave=False, bar_format="{l_bar}{bar}|")
        self._shown = -1

    def __call__(self, done: float) -> None:
        percent = int(100 * done)
        if percent == self._shown:
            return
        if self._tqdm is not None:
            self._tqdm.update(percent - max(self._shown, 0))
            if percent >= 100:
                self._tqdm.close()
        else:
            end = "\n" if percent >= 100 else ""
            sys.stderr.write(f"\r[{'#' * (percent // 4):25}] {percent:3d} %{end}")
            sys.stderr.flush()
        self._shown = percent


def callback(progress: Progress) -> Callable[[float], object] | None:
    """The callable that the native part calls, or None."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _Bar()
    return progress

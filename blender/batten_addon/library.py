"""The library, which lies beside this file."""

from __future__ import annotations

import importlib
import pathlib
import sys
from typing import Any


class Missing(RuntimeError):
    """The native part does not fit this Blender."""


def batten() -> Any:
    """The package, imported at first use so that an add-on which does not fit can still say why."""
    beside = str(pathlib.Path(__file__).parent / "vendor")
    if beside not in sys.path:
        sys.path.insert(0, beside)
    try:
        return importlib.import_module("batten")
    except ImportError as error:
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        raise Missing(
            f"Batten's native part does not fit this Blender (Python {version}, {sys.platform}): {error}. "
            "Build the add-on on this machine: ./batten blender"
        ) from error

"""Objects of the native part pickle and copy as what they were made of."""

from __future__ import annotations

from typing import Any


def _make(cls: type, args: tuple[Any, ...], kwargs: dict[str, Any]) -> Any:
    return cls(*args, **kwargs)


class Rebuilt:
    """Remembers its arguments, all but ``progress``; built from a copy of them again, it gives the same bits."""

    _made_of: tuple[tuple[Any, ...], dict[str, Any]] | None

    def __new__(cls, *args: Any, **kwargs: Any) -> Any:
        made = super().__new__(cls)
        kwargs.pop("progress", None)
        made._made_of = (args, kwargs)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        assert self._made_of is not None
        return (_make, (type(self), *self._made_of))

"""The one exception that this package raises."""

from __future__ import annotations


class Error(ValueError):
    """What went wrong: the message names the element and says what to do.

    Attributes:
        code: the kind, for programs, such as ``"non-manifold-edge"`` or ``"singular-system"``.
    """

    code: str

    def __init__(self, message: str, code: str = "bad-argument") -> None:
        super().__init__(message)
        self.code = code

    def __reduce__(self) -> tuple[type["Error"], tuple[str, str]]:
        return (Error, (str(self), self.code))

"""Types of the part that reads and writes files of volumes, which a build may lack."""

from typing import Any

import numpy as np
import numpy.typing as npt

def set_error_type(type: type[Exception], /) -> None: ...
def read(path: str, /) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float64]]: ...
def write(path: str, values: npt.NDArray[Any], affine: npt.NDArray[np.float64], bytes: bool, /) -> None: ...

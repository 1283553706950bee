"""Names for the array types that cross module borders."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

__all__ = ["Array", "ArrayLike", "BoolArray", "IntArray"]

import os as _os
import sys as _sys

# The functions of <cmath> that give the same bits on every processor (msgs/portable_math.cpp) go before those of the
# interpreter's C library, for the libraries that are loaded with the module too.
_flags = _sys.getdlopenflags()
_sys.setdlopenflags(_flags | _os.RTLD_DEEPBIND)
try:
    from . import _maploop
finally:
    _sys.setdlopenflags(_flags)
from ._maploop import *  # noqa: E402,F401,F403

__doc__, __version__ = _maploop.__doc__, _maploop.__version__

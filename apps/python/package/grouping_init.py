# SPDX-License-Identifier: MIT
"""The groupers of Corral alone: which matches between two surfaces to keep."""

from . import tables
from .tables import *

__all__ = tables.__all__

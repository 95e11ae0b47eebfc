# SPDX-License-Identifier: MIT
"""Corral: which matches between two surfaces to keep, and how well the surfaces align by them."""

from . import surfaces, tables
from .surfaces import *
from .tables import *

__all__ = tables.__all__ + surfaces.__all__

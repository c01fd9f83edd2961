# SPDX-License-Identifier: MIT
"""Runs the package by the name of its folder. Python takes that for a folder of single modules, so
the folder above it is made the one in which imports are looked for."""

import os
import sys

sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
from report import command  # noqa: E402 # pylint: disable=wrong-import-position

command.main()

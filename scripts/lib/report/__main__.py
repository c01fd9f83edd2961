# SPDX-License-Identifier: MIT
"""Runs the package by the name of its folder, which Python then takes for a folder of single modules:
the folder above it is where imports are looked for instead."""

import os
import sys

sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
from report import command  # noqa: E402 # pylint: disable=wrong-import-position

command.main()

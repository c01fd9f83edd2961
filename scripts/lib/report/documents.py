# SPDX-License-Identifier: MIT
"""JSON files as what the reports are made of: read whole, with one line about what is wrong."""

import json


class Malformed(Exception):
    """What is wrong with a document that a page cannot be made of."""


def read(path):
    """The JSON in a file. Raises Malformed, or OSError when the file cannot be read."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except ValueError as error:
        raise Malformed(f"this is no JSON: {error}") from error


def reason(error):
    """What an exception says of a document, without what only a programmer understands."""
    return getattr(error, "strerror", None) or str(error)

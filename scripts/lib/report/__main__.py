# SPDX-License-Identifier: MIT
"""Usage: python3 report RESULTS.JSON OUT.HTML

Writes the study's results as a page with plots. Exit status 1 if they are malformed or the page
cannot be written, with nothing written."""

import os
import sys

import results
from parts import write_whole


def main(source, target):
    try:
        study = results.load(source)
    except (OSError, results.Malformed) as error:
        sys.exit(f"{source}: {getattr(error, 'strerror', None) or error}")
    try:
        import page  # pylint: disable=import-outside-toplevel # needs Matplotlib
    except ModuleNotFoundError as error:
        sys.exit(f"Python has no module {error.name}: install the package python3-{error.name}")
    folder = os.path.dirname(os.path.abspath(target))
    text = page.make(study, os.path.relpath(source, folder))
    write_whole(target, text)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])

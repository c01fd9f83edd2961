# SPDX-License-Identifier: MIT
"""Makes one of the reports' pages from what was measured. If that is malformed or the page cannot
be written, the exit status is 1, one line says why, and nothing is written."""

import argparse
import sys


def _transparency(options):
    from . import transparency  # needs Matplotlib, which the other pages do without
    transparency.write(options.results, options.out)


def _volume(options):
    from . import volume
    volume.write(options.results, options.out)


def _hard_cases(options):
    from . import hard_cases
    hard_cases.write(options.folder, options.out)


def _demo(options):
    from . import demo
    demo.write(options.folder, options.driver, options.pictures, options.drawing)


def _parser():
    parser = argparse.ArgumentParser(prog="report", description=__doc__)
    kinds = parser.add_subparsers(metavar="KIND", required=True)

    kind = kinds.add_parser("transparency", help="the study of transparency methods, with plots")
    kind.add_argument("results", metavar="RESULTS.json", help="what kbuffer-bench wrote")
    kind.add_argument("out", metavar="OUT.html")
    kind.set_defaults(write=_transparency)

    kind = kinds.add_parser("volume", help="the study of volumes, with the pictures in the folder "
                            "of the JSON's name")
    kind.add_argument("results", metavar="VOLUME.json", help="what volume_study.py wrote")
    kind.add_argument("out", metavar="OUT.html")
    kind.set_defaults(write=_volume)

    kind = kinds.add_parser("hard-cases", help="the table of the hard cases; prints what is not as "
                            "promised, and last \"N passed, N failed, N skipped\"")
    kind.add_argument("folder", metavar="FOLDER", help="where tests/hard_cases/run put its rows")
    kind.add_argument("out", metavar="OUT.html", help="beside it all rows go, as OUT.json")
    kind.set_defaults(write=_hard_cases)

    kind = kinds.add_parser("demo", help="the demo's page, FOLDER/index.html; prints a line for "
                            "each picture")
    kind.add_argument("--driver", required=True, metavar="TEXT", help="what scripts/run --which "
                      "prints: the driver that draws")
    kind.add_argument("--drawing", action="store_true",
                      help="more is being drawn: the page loads itself anew until it is there")
    kind.add_argument("folder", metavar="FOLDER")
    kind.add_argument("pictures", metavar="NAME=WHAT", nargs="+",
                      help="a picture, FOLDER/NAME.png, with what the sample that drew it wrote by "
                      "--json, FOLDER/NAME.json, and what it shows, in words")
    kind.set_defaults(write=_demo)
    return parser


def main():
    options = _parser().parse_args()
    try:
        options.write(options)
    except ModuleNotFoundError as error:
        sys.exit(f"Python has no module {error.name}: install the package python3-{error.name}")

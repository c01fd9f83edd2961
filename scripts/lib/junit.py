"""Counts the tests in a JUnit file: names those that failed, prints last "N passed, N failed, N
skipped"."""

import sys
import xml.etree.ElementTree as et


def main(path):
    try:
        cases = list(et.parse(path).iter("testcase"))
    except (OSError, et.ParseError) as error:
        sys.exit(f"no test results: {error}")
    failed = [c for c in cases if c.find("failure") is not None or c.find("error") is not None]
    skipped = [c for c in cases if c.find("skipped") is not None]
    for case in failed:
        print("not ok", case.get("classname") or "", case.get("name"))
    for case in skipped:
        print("skipped", case.get("classname") or "", case.get("name"))
    print(f"{len(cases) - len(failed) - len(skipped)} passed, {len(failed)} failed, "
          f"{len(skipped)} skipped")


main(sys.argv[1])

#!/usr/bin/env python3
"""Which tests of a ctest run failed, with the end of what each printed; the last line is the count and their names.

usage: failed_tests.py RESULTS.xml [LINES]      RESULTS.xml: from `ctest --output-junit`; LINES: of all outputs together,
default 60, so that the end of a long log shows them; prints nothing when no test failed
"""

import sys
import xml.etree.ElementTree

LEAST = 8  # lines of a test's output that say something


def has_failed(case):
    """One that ctest could not run has failed too; one that skips itself has not."""
    skipped = case.find("skipped")
    not_run = case.get("status") == "notrun" and skipped is not None and not skipped.get("message", "").startswith("SKIP_")
    return case.get("status") == "fail" or not_run


def report(suite, lines):
    failed = [case for case in suite.iter("testcase") if has_failed(case)]
    if not failed:
        return []
    share = max(LEAST, lines // len(failed))
    printed = []
    for case in failed[:max(1, lines // LEAST)]:
        output = (case.findtext("system-out") or "").rstrip().splitlines()
        printed.append(f"FAILED {case.get('name')} after {float(case.get('time')):.1f} s")
        if len(output) > share:
            printed.append(f"  ({len(output) - share} lines before these)")
        printed += [f"  {line}" for line in output[-share:]]
    return printed + [f"{len(failed)} of {sum(1 for _ in suite.iter('testcase'))} tests failed: {', '.join(case.get('name') for case in failed)}"]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    suite = xml.etree.ElementTree.parse(sys.argv[1]).getroot()
    for line in report(suite, int((sys.argv[2:] or [60])[0])):
        print(line)


if __name__ == "__main__":
    main()

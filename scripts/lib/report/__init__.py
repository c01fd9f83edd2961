# SPDX-License-Identifier: MIT
"""The pages that the commands write: of the demo, of the studies of transparency and of volumes,
and of the hard cases. Each has a module, which reads what was measured as JSON and works out what
is to be said, and a template of Jinja2 in the folder templates/, which says it in HTML. The
package's folder is the command that makes them: python3 scripts/lib/report --help. A further page,
of piglit's regression tests, has its template here and its module beside those tests:
piglit-tests/regression/table.py."""

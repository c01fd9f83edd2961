"""lint.py HOOKS OVERLAY RELEASE SERIES

Judges the form of each hook: what Mesa's maintainers ask of a patch, and that a hook changes files
of Mesa and nothing else. HOOKS holds the hooks, OVERLAY the new files, RELEASE the files of Mesa that
hooks change, SERIES what `scripts/patch export` made of both. One line a hook; the last is
"N passed, N failed, N skipped"."""

import email
import email.policy
import os
import re
import sys

SUBJECT_COLUMNS = 75  # Mesa's limit
BODY_COLUMNS = 80  # what `git log` shows on a terminal without wrapping, less its indentation of 4
# The last line of a message, as OpenEmbedded has it
UPSTREAM_STATUS = r"Upstream-Status: (Pending|(Submitted|Accepted|Denied|Inappropriate) \[.+\])"


def hunks(diff):
    """The hunks of a patch: (removed lines, added lines)."""
    for hunk in re.split(r"^@@ .*$", diff, flags=re.MULTILINE)[1:]:
        # The next file's header, or the trailer, is no part of it.
        lines = re.split(r"^(?:diff --git |-- $)", hunk, flags=re.MULTILINE)[0].split("\n")
        yield ([l[1:] for l in lines if l.startswith("-")],
               [l[1:] for l in lines if l.startswith("+")])


def without_space(lines):
    return "".join("".join(lines).split())


def form_of_message(subject, body):
    if not re.fullmatch(r"[a-z0-9_/-]+: [^\s].*[^.\s]", subject):
        yield f"subject is not of the form 'module: summary': {subject}"
    if len(subject) > SUBJECT_COLUMNS:
        yield f"subject has {len(subject)} columns"
    *reason, status = body.rstrip().split("\n")
    if not "".join(reason).strip():
        yield "says nothing of why it is there"
    if not re.fullmatch(UPSTREAM_STATUS, status):
        yield "does not end with its state upstream, as 'Upstream-Status: Pending'"
    for line in body.split("\n"):
        if len(line) > BODY_COLUMNS:
            yield f"line of {len(line)} columns: {line}"


def belongs(module, files):
    """A module's hook changes something in its folder, and no other driver."""
    if not any(module.split("/")[-1] in file.split("/") or
               module.split("/")[-1] == os.path.splitext(os.path.basename(file))[0]
               for file in files):
        yield f"changes nothing of {module}"
    for file in files:
        part = re.match(r"src/gallium/(?:drivers|auxiliary|frontends)/([^/]+)/", file)
        if part and part[1] != module:
            yield f"changes {file}, which is not of {module}"


def form_of_change(diff, files, overlay, release):
    if re.search(r"^(new file|deleted file|rename|copy|old mode|new mode|GIT binary)", diff,
                 re.MULTILINE):
        yield "adds, removes, renames or sets the mode of a file"
    for file in files:
        if os.path.lexists(os.path.join(overlay, file)):
            yield f"changes {file}, which is ours"
        elif not os.path.isfile(os.path.join(release, file)):
            yield f"changes {file}, which the release has not"
    if len(files) != len(set(files)):
        yield "changes a file twice"
    for removed, added in hunks(diff):
        if without_space(removed) == without_space(added):
            yield f"changes nothing but white space: {(added or removed or [''])[0].strip()}"
        for line in added:
            if line != line.rstrip() or " \t" in re.match(r"\s*", line)[0]:
                yield f"white space error: {line}"


def faults(path, overlay, release):
    with open(path, encoding="utf-8", newline="") as file:
        message = email.message_from_file(file, policy=email.policy.default)
    text = message.get_payload()
    # An empty body leaves "---" as the first line.
    body, _, diff = ("\n" + text).partition("\n---\n")
    subject = re.sub(r"^\[PATCH\] ", "", " ".join(message["Subject"].split()))
    files = re.findall(r"^diff --git a/(\S+) b/", diff, re.MULTILINE)
    yield from form_of_message(subject, body)
    yield from belongs(subject.split(":")[0], files)
    yield from form_of_change(diff, files, overlay, release)


def main(hooks, overlay, release, series):
    passed = failed = 0

    def judge(name, found):
        nonlocal passed, failed
        found = list(found)
        if found:
            failed += 1
            print("not ok", name)
            print("".join(f"    {fault}\n" for fault in found), end="")
        else:
            passed += 1

    # The numbers run through all folders.
    paths = {name: os.path.join(folder, name)
             for folder, _, names in os.walk(hooks) for name in names}
    names = sorted(paths)
    exported = sorted(name for name in os.listdir(series) if name.endswith(".patch"))
    for number, name in enumerate(names, 1):
        judge(name, faults(paths[name], overlay, release))
    judge("numbers of the hooks run from 1", (
        f"{name} is number {number}" for number, name in enumerate(names, 1)
        if not re.fullmatch(rf"{number:04}-.+\.patch", name)))
    # So that `scripts/patch refresh` leaves alone what nobody has edited
    judge("hooks are what git format-patch writes", different(paths, names, series, exported))
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


def without_author(text):
    """An export names another than the hook, in whose head the name may take two lines."""
    head, separator, rest = text.partition(b"\n\n")
    return re.sub(rb"\nFrom: .*(\n .*)*", b"", head) + separator + rest


def different(paths, names, series, exported):
    # The parts of the overlay, if there is one, are the first of the exported series.
    exported = exported[len(exported) - len(names):]
    for name, other in zip(names, exported):
        with open(paths[name], "rb") as ours:
            with open(os.path.join(series, other), "rb") as theirs:
                if name[4:] != other[4:] or (
                        without_author(ours.read()) != without_author(theirs.read())):
                    yield f"{name} is not {other}"


sys.exit(main(*sys.argv[1:]))

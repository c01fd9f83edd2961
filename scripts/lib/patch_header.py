# SPDX-License-Identifier: MIT
"""patch_header.py git|debian AUTHOR PATCH...

Rewrites the head of patches that `git format-patch` wrote: names AUTHOR as theirs, and for Debian
puts the fields of DEP-3 (https://dep-team.pages.debian.net/deps/dep3/) in the place of a mail's."""

import email
import email.policy
import email.utils
import sys


def git_form(text, author):
    """Only the sender is another; `From`, the mail separator, stays the first line."""
    head, _, rest = text.partition("\n\n")
    lines = []
    for line in head.split("\n"):
        if line.startswith("From: "):
            line = f"From: {author}"
        elif line.startswith(" ") and lines[-1] == f"From: {author}":
            continue  # What follows of a sender that took two lines.
        lines.append(line)
    return "\n".join(lines) + "\n\n" + rest


def debian_form(text, author):
    mail = email.message_from_string(text.partition("\n")[2], policy=email.policy.default)
    subject = " ".join(mail["Subject"].split()).removeprefix("[PATCH] ")
    # An empty body leaves "---" as the first line.
    body, _, diff = ("\n" + mail.get_payload()).partition("\n---\n")
    paragraphs = [line or "." for line in body.strip().split("\n")] if body.strip() else []
    date = email.utils.parsedate_to_datetime(mail["Date"]).strftime("%Y-%m-%d")
    fields = [f"Description: {subject}", *(f" {line}" for line in paragraphs), f"Author: {author}",
              "Origin: other, mesa-kbuffer", "Forwarded: no", f"Last-Update: {date}"]
    return "\n".join(fields) + "\n---\n" + diff


def main(form, author, *paths):
    rewrite = {"git": git_form, "debian": debian_form}[form]
    for path in paths:
        with open(path, encoding="utf-8", newline="") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(rewrite(text, author))


main(*sys.argv[1:])

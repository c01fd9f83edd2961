# SPDX-License-Identifier: MIT
"""Files that the commands write, by the rules of samples/lib/io/output_file.hpp: a regular file is
replaced as a whole or not at all and keeps its permissions, a device or a pipe is opened and
written, - is the standard output, and symbolic links are followed."""

import contextlib
import errno
import os
import shutil
import stat
import tempfile


def find(path):
    """What a name stands for: the number of an open file, or the name of a file that is no link."""
    if path == "-":
        return 1
    name = path
    for _ in range(40):
        folder = os.path.realpath(os.path.dirname(name) or ".")
        base = os.path.basename(name)
        if folder == f"/proc/{os.getpid()}/fd" and base.isdigit():
            return int(base)
        if not os.path.islink(name):
            return name
        name = os.path.join(folder, os.readlink(name))
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), path)


def is_standard_output(path):
    return find(path) == 1


@contextlib.contextmanager
def written(path):
    """Gives the name of a new file, for the block to write. When that ends well, it becomes PATH."""
    target = find(path)
    try:
        status = None if isinstance(target, int) else os.stat(target)
    except FileNotFoundError:
        status = None
    replaced = not isinstance(target, int) and (status is None or stat.S_ISREG(status.st_mode))
    folder = os.path.dirname(os.path.abspath(target)) if replaced else None
    with tempfile.TemporaryDirectory(prefix=".kbuffer-", dir=folder) as temporary:
        made = os.path.join(temporary, "made")
        yield made
        if not replaced:
            with open(made, "rb") as source, open(target, "wb", closefd=target != 1) as file:
                shutil.copyfileobj(source, file)
            return
        if status:
            with contextlib.suppress(PermissionError):  # Root alone can keep another owner.
                os.chown(made, status.st_uid, status.st_gid)
            os.chmod(made, stat.S_IMODE(status.st_mode))
        os.replace(made, target)

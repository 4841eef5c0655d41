"""Files opened as what they are meant to be: regular ones, never a pipe or a device; new ones never through a link."""

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path

_ALWAYS = os.O_CLOEXEC | os.O_NONBLOCK      # to open a pipe would wait for its other end


def _checked(handle, path, single=False):
    """The ``handle`` of a regular file; OSError for anything else. ``single``: nor one that has a second name."""
    status = os.fstat(handle)
    if not stat.S_ISREG(status.st_mode) or (single and status.st_nlink > 1):
        os.close(handle)
        raise OSError(errno.EINVAL, "not a regular file" if not stat.S_ISREG(status.st_mode) else
                      "a file with a second name elsewhere", str(path))
    return handle


def _open(path, flags, mode=0o666):
    try:
        return os.open(path, flags | _ALWAYS, mode)
    except OSError as error:
        if error.errno == errno.ELOOP and os.path.islink(path):
            raise OSError(errno.ELOOP, "a symbolic link", str(path)) from None
        raise


def open_regular(path, links=True):
    """Binary stream of the regular file at ``path``; OSError for none, others and, without ``links``, a link."""
    handle = _open(path, os.O_RDONLY | (0 if links else os.O_NOFOLLOW))
    return os.fdopen(_checked(handle, path), "rb")


def read_regular(path, most, links=True):
    """Bytes of a regular file of at most ``most`` bytes; OSError for others."""
    with open_regular(path, links) as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"more than {most} bytes", str(path))
    return content


def open_lock(path):
    """Descriptor of a lock file, made where there is none; OSError for a link and for what is no file of its own."""
    handle = _open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o644)
    return _checked(handle, path, single=True)


def cleared(path):
    """``path`` with nothing at it: a file or a link that is there, not what it leads to, is removed."""
    Path(path).unlink(missing_ok=True)
    return path


def write_new(path, content):
    """Write bytes to a file that is made for them; what is at ``path`` is removed, and no link followed."""
    handle = _open(cleared(path), os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW)
    with os.fdopen(handle, "wb") as stream:
        stream.write(content)


def is_plain(path):
    """Whether a regular file, and no link to one, is at ``path``."""
    with suppress(OSError):
        return stat.S_ISREG(os.lstat(path).st_mode)
    return False

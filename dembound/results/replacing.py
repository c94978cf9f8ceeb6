"""Files that replace another one when they are complete."""

import errno
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


def require_folder(path: Path) -> None:
    """Raise FileNotFoundError, with the name of the folder, if the folder of `path` does not exist."""
    if not path.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "there is no such folder", str(path.parent))


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a neighbouring path to write to; the file replaces `path` if there was no error.

    Raises FileNotFoundError as `require_folder`.
    """
    require_folder(path)
    part = path.with_name(f"{path.name}.part")
    try:
        yield part
        part.replace(path)
    except BaseException as error:
        if isinstance(error, OSError) and error.filename is None:
            error.filename = str(path)  # errors of writing have no file name
        with suppress(OSError):
            part.unlink(missing_ok=True)
        raise

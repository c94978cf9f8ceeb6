"""Packed bricks kept on disk, one file per set of parameters.

A brick depends only on its parameters, so a file is never out of date. It ends with a digest of all bytes before it;
a damaged file, or one without a valid brick, is packed again and replaced, with a line in the log.
"""

import contextlib
import hashlib
import io
import json
import logging
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from filelock import Timeout

from dembound.errors import RecordError
from dembound.files import DAMAGED, arrays_of, content_of, lock_of, replacing
from dembound.interrupts import look
from dembound.machine import private_folder, user_cache
from dembound.packings.brick import Brick

LOGGER = logging.getLogger(__name__)

FORMAT = 3  # raise it whenever the packing procedure or the file layout changes

LOOK = 0.5
"""Seconds between two checks for a request to end, while another process packs."""

LARGEST, EXPANDED = 2**29, 16
"""Largest size (bytes) of a file that is read, and of its arrays over the file: numbers are hardly compressed."""

DIGEST = hashlib.sha256
"""Computes the digest at the end of a file, which is still a valid NPZ file."""


def cache_folder() -> Path:
    """Folder of the bricks: the environment variable DEMBOUND_CACHE, else the user's cache folder.

    It is a private temporary one where that cannot be written.
    """
    chosen = os.environ.get("DEMBOUND_CACHE")
    return Path(chosen) if chosen else (user_cache() or private_folder()) / "bricks"


def load_or_pack(key_params: Mapping[str, Any], pack: Callable[[], Brick]) -> Brick:
    """The brick with these parameters, from the cache, else packed and written to it.

    key_params contains all parameters of the brick, as JSON values; pack() makes it. If another process is packing the
    same brick, this call waits for it. If a brick cannot be written (no space, no permission), it is still returned.
    """
    path = cache_folder() / f"brick-{_digest(key_params)}.npz"
    if (brick := _load(path)) is not None:
        return brick
    with _alone(path.with_suffix(".lock")) as waited:
        if not waited or (brick := _load(path)) is None:
            brick = pack()
            _save(brick, path)
    return brick


@contextlib.contextmanager
def _alone(path: Path) -> Iterator[bool]:
    """Inside, no other process holds this lock; yields whether another one had to be waited for.

    If no lock can be made, as in a folder without permission to write, it does not wait.
    """
    lock, waited = None, False
    with contextlib.suppress(OSError, NotImplementedError, RecordError):
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = lock_of(path)
        try:
            lock.acquire(blocking=False)
        except Timeout:
            waited = True
            while not lock.is_locked:
                look()
                with contextlib.suppress(Timeout):
                    lock.acquire(timeout=LOOK)
    try:
        yield waited
    finally:
        if lock is not None and lock.is_locked:
            with contextlib.suppress(OSError):  # Windows keeps a file that is open
                path.unlink()
            lock.release()


def clear() -> int:
    """Delete all cached bricks and return their number."""
    files = list(cache_folder().glob("brick-*.npz"))
    for path in files:
        path.unlink(missing_ok=True)
    return len(files)


def _digest(key_params: Mapping[str, Any]) -> str:
    text = json.dumps({"format": FORMAT, **key_params}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _load(path: Path) -> Brick | None:
    """The brick of a file; None if there is no file or it is damaged, in which case it is logged."""
    size = DIGEST().digest_size
    try:
        content = content_of(path, LARGEST)
    except OSError:
        return None
    except RecordError:  # a link, or what cannot be a brick
        content = b""
    if content and DIGEST(content[:-size]).digest() == content[-size:]:
        with contextlib.suppress(*DAMAGED):  # written by something else
            arrays = arrays_of(io.BytesIO(content), EXPANDED * len(content))
            brick = Brick(**{**arrays, "residual_ratio": float(arrays["residual_ratio"])})
            brick.check()
            return brick
    LOGGER.info("the cached brick %s is damaged, it is packed again", path)
    return None


def _save(brick: Brick, path: Path) -> None:
    content = io.BytesIO()
    np.savez_compressed(content, **asdict(brick))
    with contextlib.suppress(OSError, RecordError):  # without a cache only time is lost
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as file:
            file.write(content.getvalue() + DIGEST(content.getvalue()).digest())

"""Scenes in files."""

from __future__ import annotations

import codecs
import os
from typing import Any

from ricochet import _core
from ricochet.values import refuse


def read_scene(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Reads a scene from a file that ``ricochet --scene`` takes: JSON or the text format of protobuf.

    Returns:
        The scene as a dictionary, with only what the file sets. One with ``contacts`` is for ``multicontact`` and
        ``cost``.

    Raises:
        InvalidRequest: the file is no scene.
        OSError: the file cannot be read.
    """
    with open(path, "rb") as file:
        text = file.read().removeprefix(codecs.BOM_UTF8)
    try:
        return _core.parse_scene(os.fsencode(path), text)
    except ValueError as error:
        try:
            text.decode()
        except UnicodeDecodeError as bytes_error:  # The words of the first error may have these bytes.
            refuse(os.fsdecode(path), f"is not UTF-8 at byte {bytes_error.start}")
        refuse(os.fsdecode(path), str(error))

"""Tables in CSV whose rows tell when they were changed, for progress.csv.

The last column, "crc32", has the CRC-32 of all bytes of the file before it, in eight hexadecimal
digits. So a table can grow by rows, and others read it as any other.
"""

from __future__ import annotations

import re
import zlib

COLUMN = "crc32"
_DIGITS = re.compile(r"(^|,)[0-9a-f]{8}$")


def checked(plain: str) -> str:
    """Returns the table `plain`, whose first line has the names of its columns, with "crc32"."""
    head, *rows = plain.removesuffix("\n").split("\n")
    text = f"{head},{COLUMN}\n"
    crc = zlib.crc32(text.encode())
    for row in rows:
        crc = zlib.crc32(f"{row},".encode(), crc)
        line_end = f"{crc:08x}\n"
        text += f"{row},{line_end}"
        crc = zlib.crc32(line_end.encode(), crc)
    return text


def plain(text: str) -> str:
    """Returns the table that checked() was given. Raises ValueError if `text` was changed since.

    Tables of earlier versions of RTG have no such column, and are returned as they are. Rows that
    are missing at the end are not noticed.
    """
    if "\n" not in text:
        raise ValueError("no whole line")
    lines = text.removesuffix("\n").split("\n")
    # A changed bit leaves one of the two, the name or the digits.
    if not (lines[0].endswith(f",{COLUMN}") or any(map(_DIGITS.search, lines))):
        return text
    found = "".join(f"{line.rpartition(',')[0]}\n" for line in lines)
    if checked(found).removesuffix("\n") != text.removesuffix("\n"):
        raise ValueError("changed")
    return found

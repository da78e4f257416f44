"""Changes of files, as accidents and strangers make them."""

import numpy as np


def changed(whole: bytes, draws: np.random.Generator) -> bytes:
    """Returns `whole` with up to four changes of bytes and stretches of bytes."""
    out = bytearray(whole)
    for _ in range(draws.integers(1, 5)):
        at, end = np.sort(draws.integers(0, len(out) + 1, 2))
        near = at + int(draws.integers(1, 9))
        match draws.integers(6):
            case 0:
                del out[at:]
            case 1:
                del out[at:near]
            case 2:
                out[at:at] = out[at : min(end, at + 500)]
            case 3:
                out[at:near] = draws.bytes(len(out[at:near]))
            case 4:
                out[at:near] = draws.choice([b"\0", b"\xff", b"\x7f", b"9"]) * len(out[at:near])
            case _:
                out[at:at] = out[int(draws.integers(0, len(out) + 1)) :][:40]
    return bytes(out)

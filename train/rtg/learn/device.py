"""Where the networks are."""

from __future__ import annotations

import torch as th

from rtg.errors import UserError


def chosen(device: str) -> str:
    """The device that `train.device` means here: cpu or cuda. Raises UserError."""
    if device == "cuda" and not th.cuda.is_available():
        raise UserError("train.device: cuda, but PyTorch sees no such device; legal: auto, cpu")
    return "cuda" if device != "cpu" and th.cuda.is_available() else "cpu"


def name(kind: str) -> str:
    """For people: of a GPU its model, else `kind`."""
    return th.cuda.get_device_name() if kind == "cuda" else kind

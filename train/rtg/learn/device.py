"""The device that holds the networks."""

from __future__ import annotations

import torch as th

from rtg.errors import UserError


def chosen(device: str) -> str:
    """Resolves `train.device` to "cpu" or "cuda". Raises UserError if cuda is missing."""
    if device == "cuda" and not th.cuda.is_available():
        raise UserError("train.device: is cuda, but PyTorch finds no CUDA device; legal: auto, cpu")
    return "cuda" if device != "cpu" and th.cuda.is_available() else "cpu"


def name(kind: str) -> str:
    """Returns a name for people: the model of the GPU if `kind` is "cuda", else `kind`."""
    return th.cuda.get_device_name() if kind == "cuda" else kind

import os

import numpy as np
import pytest
import torch as th
from rtg import _core
from rtg.files.dataset import Rows
from rtg.pictures import plots
from training_runs import TINY

os.environ["SDL_VIDEODRIVER"] = "dummy"  # windows are drawn, but not on a screen
os.environ["CUDA_VISIBLE_DEVICES"] = ""  # what is compared bit by bit is computed on the processor
th.set_num_threads(1)  # more threads than idle cores make small networks a hundred times slower


@pytest.fixture(scope="session")
def rows() -> Rows:
    """2,000 transitions of a generation."""
    parts: list[Rows] = []

    def store(poses, action, after, success, source) -> None:
        parts.append(Rows(poses, action, after, success.astype(np.float32), success, source))

    _core.generate(_core.Config.from_file(TINY), store, lambda line: None)
    return Rows(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


@pytest.fixture
def figures(monkeypatch):
    """The figures that are drawn, instead of their files."""
    drawn = []
    monkeypatch.setattr(plots, "save", lambda figure, _: drawn.append(figure))
    yield drawn
    plots.plt.close("all")

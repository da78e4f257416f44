"""The figures of a run: learning curve, replay gap, and the words on its state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from rtg.files import replay_gaps
from rtg.view.scene import TIME

Floats = NDArray[np.float64]

INTERACTIONS = "interactions"  # a second time line, of the learning curve alone
GAP, LEARNING, STATE = "replay_gap", "learning", "state"  # paths of the entities
_BLUE, _ORANGE = (74, 126, 187), (217, 130, 43)
# Columns of progress.csv, their names in the plot and their colours.
CURVES = {
    "success_rate": ("greedy policy, held-out starts", _BLUE),
    "rollout_success": ("training roll-outs", _ORANGE),
}


def log_curve_styles(recording: rr.RecordingStream) -> None:
    """Logs names and colours of the curves."""
    for column, (name, colour) in CURVES.items():
        style = rr.SeriesLines(colors=[colour], names=[name], widths=[2.0])
        recording.log(f"{LEARNING}/{column}", style, static=True)


def log_evaluation(recording: rr.RecordingStream, at: float, row: Mapping[str, float]) -> None:
    """Adds one row of progress.csv to the learning curve at time `at` [s]."""
    recording.set_time(TIME, duration=at)
    recording.set_time(INTERACTIONS, sequence=int(row["interactions"]))
    for column in CURVES:
        if np.isfinite(row.get(column, np.nan)):
            recording.log(f"{LEARNING}/{column}", rr.Scalars(row[column]))
    recording.disable_timeline(INTERACTIONS)


def log_gaps(recording: rr.RecordingStream, at: float, gaps: Sequence[float]) -> None:
    """Logs the histogram of replay gaps [m], over their decimal logarithm, at time `at` [s]."""
    recording.set_time(TIME, duration=at)
    edges = np.log10(replay_gaps.EDGES)
    counts = np.array(replay_gaps.counts(gaps), float)
    shown = slice(0, int(np.flatnonzero(counts).max(initial=0)) + 1)
    centres, widths = (edges[1:] + edges[:-1]) / 2.0, np.diff(edges)
    recording.log(
        GAP,
        rr.BarChart(counts[shown], abscissa=centres[shown], widths=widths[shown], color=_BLUE),
    )


def log_state(recording: rr.RecordingStream, at: float, words: str) -> None:
    """Shows `words`, in Markdown, from time `at` [s] on."""
    recording.set_time(TIME, duration=at)
    recording.log(STATE, rr.TextDocument(words, media_type=rr.MediaType.MARKDOWN))

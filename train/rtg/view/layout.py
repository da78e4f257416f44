"""The panels: the scene, the trees of each object, the figures of learning and search."""

from __future__ import annotations

from collections.abc import Sequence

import rerun.blueprint as rrb

from rtg import _core
from rtg.pictures.draw import PAPER, arena_window, objects
from rtg.view.figures import GAP, LEARNING, STATE
from rtg.view.scene import TIME
from rtg.view.trees import tree_path

_NO_BOUND = rrb.TimeRangeBoundary.infinite()
_ALL_TIME = rrb.TimeRange(start=_NO_BOUND, end=_NO_BOUND)
_HEIGHT = 2.45  # of the eye above the plane, in half widths of the window


def _from_above(
    config: _core.Config, name: str, contents: Sequence[str], whole: bool = False
) -> rrb.Spatial3DView:
    """Returns a view from above. `whole`: it shows all that was logged up to the time shown."""
    window = arena_window(config.task)
    until_now = rrb.VisibleTimeRange(
        TIME,
        start=_NO_BOUND,
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    return rrb.Spatial3DView(
        name=name,
        origin="/",
        contents=[f"/{path}" for path in contents],
        background=PAPER,
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            kind=rrb.Eye3DKind.Orbital,
            position=(window.x, window.y, _HEIGHT * window.half),
            look_target=(window.x, window.y, 0.0),
            eye_up=(0.0, 1.0, 0.0),
        ),
        time_ranges=[until_now] if whole else None,
    )


def _learning() -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        name="success",
        origin=f"/{LEARNING}",
        axis_x=rrb.TimeAxis(view_range=_ALL_TIME),
        # with room for the legend above 1
        axis_y=rrb.ScalarAxis(range=(-0.03, 1.3), zoom_lock=True),
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop),
    )


def _trees(config: _core.Config) -> rrb.Grid:
    task = config.task
    fixed = ("scene/arena", "scene/goal/**", "starts", "legend/**")
    bodies = objects(task)
    return rrb.Grid(
        *(
            _from_above(
                config,
                f"moves of {task.names[body]}",
                [*fixed, f"start/{task.names[body]}", tree_path(task, body)],
                whole=True,
            )
            for body in bodies
        ),
        grid_columns=round(len(bodies) ** 0.5),  # panels wider than high hold the whole arena
        name="trees",
    )


def layout(config: _core.Config, time_panel: rrb.TimePanel) -> rrb.Blueprint:
    """Returns the panels of a run; without trees if the run generates no transitions."""
    scene = _from_above(config, "scene", ["scene/**", "caption"])
    state = rrb.TextDocumentView(name="run", origin=f"/{STATE}")
    if config.train.offline:
        gaps = rrb.BarChartView(
            name="replay gap: steps by log10 of metres",
            origin=f"/{GAP}",
            plot_legend=rrb.PlotLegend(visible=False),
        )
        left = rrb.Vertical(scene, rrb.Horizontal(_learning(), gaps), row_shares=[3, 2])
        right = rrb.Vertical(_trees(config), state, row_shares=[5, 1])
    else:
        left, right = rrb.Vertical(scene), rrb.Vertical(_learning(), state, row_shares=[3, 1])
    return rrb.Blueprint(
        rrb.Horizontal(left, right, column_shares=[1, 1]),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        time_panel,
        auto_layout=False,
        auto_views=False,
    )


def following() -> rrb.TimePanel:
    """Returns the time panel of a running run: it shows the newest state."""
    return rrb.TimePanel(state="collapsed", timeline=TIME, play_state="following")


def playing(speed: float) -> rrb.TimePanel:
    """Returns the time panel of a finished run: it plays from begin to end, again and again.

    `speed`: of the play, where 1 is that of the run.
    """
    return rrb.TimePanel(
        state="collapsed",
        timeline=TIME,
        play_state="playing",
        playback_speed=speed,
        loop_mode="all",
    )

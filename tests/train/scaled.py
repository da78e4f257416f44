"""The task Gathering in any size: in the units of tasks it is always the same."""

from rtg import _core

BOXES = {"box1": (-3.0, 1.13, 0.2), "box2": (2.63, 2.25, -0.3), "box3": (2.25, -2.25, 0.6)}


def gathering(scale: float) -> _core.Config:
    """Returns the task with all lengths times `scale`."""
    box = f"shape: {{box: [{1.2 * scale:.10g}, {1.2 * scale:.10g}]}}"
    boxes = [
        f"    - {{name: {name}, kind: box, {box}, friction: 0.5, "
        f"start: [{x * scale:.10g}, {y * scale:.10g}, {theta}]}}"
        for name, (x, y, theta) in BOXES.items()
    ]
    robot = f"shape: {{regular: {{sides: 6, radius: {0.8 * scale:.10g}}}}}, friction: 0.5"
    lines = [
        "task:",
        "  name: scaled",
        "  bodies:",
        f"    - {{name: robot, kind: robot, {robot}, start: [0.0, {-5.0 * scale:.10g}, 0.0]}}",
        *boxes,
        f"  goal: [{{disc: {{centre: [0.0, 0.0], radius: {2.0 * scale:.10g}}}}}]",
        f"  push: {{headings: 48, stride: {2.0 * scale:.10g}, arena: {8.0 * scale:.10g}}}",
        f"  start_jitter: {0.1 * scale:.10g}",
    ]
    return _core.Config.from_text("\n".join(lines))

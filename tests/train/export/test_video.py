"""Films: their frames, and when each is shown."""

import numpy as np
import pytest
from rtg.export.video import Film

av = pytest.importorskip("av", reason="the extra `lerobot` is not installed")


def test_every_frame_is_there_at_its_time(tmp_path):
    shades = [10, 90, 170, 250, 50]
    with Film(tmp_path / "film.mp4", fps=4, side=32) as film:
        for shade in shades:
            film.add(np.full((32, 32, 3), shade, np.uint8))
    with av.open(str(tmp_path / "film.mp4")) as container:
        stream = container.streams.video[0]
        assert (stream.codec_context.name, stream.pix_fmt) == ("h264", "yuv420p")
        assert (stream.width, stream.height, stream.average_rate) == (32, 32, 4)
        frames = list(container.decode(stream))
    assert [float(frame.pts * frame.time_base) for frame in frames] == [0, 0.25, 0.5, 0.75, 1.0]
    means = [frame.to_ndarray(format="rgb24").mean() for frame in frames]
    np.testing.assert_allclose(means, shades, atol=4)  # yuv420p has fewer levels


def test_a_film_that_is_broken_off_raises_what_broke_it(tmp_path):
    with pytest.raises(KeyError, match="cause"), Film(tmp_path / "film.mp4", 4, 32):
        raise KeyError("cause")

"""The page in a browser, whose picture has to show scene, trees and curve where they belong."""

import io
import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip("rerun", reason="the extra view is not installed")

from PIL import Image
from rtg import paths
from rtg.pictures.draw import KIND_PALETTE, ROBOT
from view_runs import free_pair, generated, learn

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

CHROMIUM = shutil.which("chromium")
WIDTH, HEIGHT = 1600, 900  # [pixel]
PATIENCE = 120  # pictures, one a second, until all must be seen
# Panels: left, top, right, bottom, as shares of the page.
SCENE, CURVE, TREES = (0.0, 0.07, 0.5, 0.59), (0.0, 0.63, 0.25, 0.96), (0.5, 0.07, 1.0, 0.8)
GREEDY, ROLLOUTS = (74, 126, 187), (217, 130, 43)
ONE_STEP = (68, 1, 84)  # the first colour of viridis
# WebGL without a graphics card.
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture
def page(tmp_path, rows):
    """The address of the view of a run that has not ended, so that it shows its last state."""
    folder = generated(tmp_path / "run", rows)
    learn(folder)
    port = free_pair()
    words = ["view", str(folder), "--port", str(port), "--no-browser"]
    process = subprocess.Popen(
        [sys.executable, "-m", "rtg.cli", *words],
        env={**os.environ, "PYTHONPATH": str(paths.ROOT / "train")},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout.readline().startswith("http://127.0.0.1:")
    yield f"http://127.0.0.1:{port}/"
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=PATIENCE)


def count(picture, panel, colour, tolerance=4):
    """Returns the number of pixels of a panel that have a colour."""
    left, top, right, bottom = panel
    part = picture[int(top * HEIGHT) : int(bottom * HEIGHT), int(left * WIDTH) : int(right * WIDTH)]
    return int((np.abs(part - np.array(colour)).max(axis=2) <= tolerance).sum())


def shows_all(picture):
    """Returns whether all panels show what they should."""
    box = KIND_PALETTE[0]
    return (
        count(picture, SCENE, box) > 1000
        and count(picture, SCENE, ROBOT) > 400
        and count(picture, CURVE, GREEDY) > 100  # of which the legend has 50
        and count(picture, CURVE, ROLLOUTS) > 100
        and count(picture, TREES, ONE_STEP) > 50
    )


@pytest.mark.skipif(CHROMIUM is None, reason="no chromium here: apt-get install chromium")
def test_the_page_shows_scene_trees_and_curve_and_asks_no_other_host(page):
    with sync_api.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        tab = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        tab.set_default_timeout(1000.0 * PATIENCE)  # as pictures take seconds on a busy machine
        requests, refused = [], []  # the viewer tries to report its use and to find new versions
        tab.on("request", lambda request: requests.append(request.url))
        tab.on("console", lambda line: refused.append(line.text) if "Policy" in line.text else None)
        tab.goto(page)
        for _ in range(PATIENCE):
            tab.wait_for_timeout(1000)
            picture = np.asarray(Image.open(io.BytesIO(tab.screenshot())).convert("RGB"), int)
            if shows_all(picture):
                break
        browser.close()
    assert shows_all(picture)
    # What belongs to one panel is in no other.
    assert count(picture, CURVE, ONE_STEP) == count(picture, SCENE, ONE_STEP) == 0
    assert count(picture, TREES, ROLLOUTS) == count(picture, SCENE, ROLLOUTS) == 0
    assert len(requests) > 3
    assert [url for url in requests if not url.startswith("http://127.0.0.1:")] == []
    assert refused != []
    assert all("has been blocked" in line or "Refused" in line for line in refused)

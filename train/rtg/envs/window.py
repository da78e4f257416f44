"""A window that shows pictures, for the render mode "human"."""

from __future__ import annotations

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray


class Window:
    """A window of pygame. Raises DependencyNotInstalled where that is missing."""

    def __init__(self, title: str, pixels: int) -> None:
        try:
            import pygame
        except ImportError:
            raise DependencyNotInstalled(
                "render_mode 'human' needs pygame: pip install "
                "'reverse-trajectory-generation[human]'"
            ) from None
        self._pygame = pygame
        pygame.display.init()
        pygame.display.set_caption(f"RTG: {title}")
        self._surface = pygame.display.set_mode((pixels, pixels))
        self._clock = pygame.time.Clock()

    def show(self, picture: NDArray[np.uint8], fps: float) -> None:
        """Shows an RGB picture [height, width, 3], and waits so that `fps` are shown per second."""
        frame = self._pygame.surfarray.make_surface(picture.transpose(1, 0, 2))
        self._surface.blit(frame, (0, 0))
        self._pygame.event.pump()
        self._pygame.display.flip()
        self._clock.tick(fps)

    def close(self) -> None:
        self._pygame.display.quit()

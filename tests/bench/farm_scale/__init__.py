"""The parts of farm_at_scale.py."""

WIDTH, HEIGHT = 3840, 2160
PARTS = 16  # 4K has so many times the pixels of the films that are measured

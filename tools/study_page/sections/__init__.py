"""One module per section of the page: measure(lab) returns plain numbers, show(results, page) turns them into HTML."""

from . import acceleration, adaptive, direct_light, global_illumination, views

SECTIONS = (views, acceleration, direct_light, global_illumination, adaptive)

"""The experiments of the quick and of the full study, as data. Times are for 2 cores without a GPU."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Profile:
    name: str
    budgets: dict                  # seconds per section; repetitions stop when they are used up
    few_seeds: int                 # of views, parts of the light and bounces
    view_size: tuple
    bvh_size: tuple                # of the timed pictures with a BVH
    brute_sizes: dict              # by mesh: of the pictures without a BVH, whose time is rays times triangles
    timings: int                   # repetitions, of which the median counts
    growth: tuple                  # triangle counts
    growth_rules: tuple            # split rules in the plot
    brute_growth: int              # largest count that is also rendered without a BVH
    direct_size: tuple
    direct_reference: int          # samples per pixel of a long render
    direct_seeds: tuple            # at least, at most
    direct_spp: tuple              # of the plots
    equal_time: tuple              # seconds
    light_size: tuple
    light_reference: int
    light_spp: int                 # of the pictures of parts and bounces
    part_reference: int
    spp: tuple                     # of the convergence plot
    spp_pictures: tuple
    spp_seeds: tuple
    roulette_spp: int
    roulette_seeds: tuple
    roulette_sizes: dict
    adaptive_size: tuple
    adaptive_reference: int
    tolerance: float
    max_spp: int
    adaptive_seeds: tuple


QUICK = Profile(
    name="quick",
    budgets={"views": 12, "acceleration": 50, "direct": 30, "global": 45, "adaptive": 28},
    few_seeds=2, view_size=(240, 180),
    bvh_size=(400, 300), brute_sizes={"cow": (160, 120), "beast": (80, 60)}, timings=3,
    growth=(100, 1000, 10000, 100000, 1000000), growth_rules=("sah",), brute_growth=1000,
    direct_size=(96, 72), direct_reference=512, direct_seeds=(2, 4), direct_spp=(1, 16, 64), equal_time=(0.5,),
    light_size=(72, 54), light_reference=1024, light_spp=16, part_reference=256,
    spp=(1, 4, 16, 64), spp_pictures=(1, 4, 16, 64), spp_seeds=(2, 4),
    roulette_spp=16, roulette_seeds=(2, 4), roulette_sizes={"spheres": (72, 54), "furnace": (32, 24)},
    adaptive_size=(48, 36), adaptive_reference=1024, tolerance=0.2, max_spp=256, adaptive_seeds=(2, 4))

FULL = Profile(
    name="full",
    budgets={"views": 90, "acceleration": 285, "direct": 480, "global": 960, "adaptive": 900},
    few_seeds=4, view_size=(640, 480),
    bvh_size=(800, 600), brute_sizes={"cow": (800, 600), "beast": (320, 240)}, timings=3,
    growth=(100, 316, 1000, 3162, 10000, 31623, 100000, 316228, 1000000), growth_rules=("sah", "mean", "median"),
    brute_growth=10000,
    direct_size=(200, 150), direct_reference=4096, direct_seeds=(4, 16), direct_spp=(1, 2, 4, 8, 16, 32, 64, 128, 256),
    equal_time=(1.0, 4.0),
    light_size=(128, 96), light_reference=8192, light_spp=64, part_reference=1024,
    spp=(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024), spp_pictures=(1, 4, 16, 64, 1024), spp_seeds=(3, 6),
    roulette_spp=64, roulette_seeds=(4, 16), roulette_sizes={"spheres": (128, 96), "furnace": (80, 60)},
    adaptive_size=(80, 60), adaptive_reference=8192, tolerance=0.05, max_spp=2048, adaptive_seeds=(4, 16))

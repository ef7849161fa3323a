"""The strand that falls, for every program alike: its numbers, its clock, and the lines that the suite reads.

A strand of 0.3 m is clamped level along +x, straight by nature, let go and followed for a second of 24 frames, without
damping. crates/bench/src/dynamics/rods.rs has the same numbers for our own solvers.

For each number of steps a frame a script prints one line of JSON:

    {"method": "PROGRAM-MODEL", "steps": 4, "seconds": 0.0012, "tips": [[0.98, -0.01, 0.0], ...]}

`seconds` is the time for a second and a strand; `tips` is where the strand ends in every frame, in lengths with y up, or
null where the program says itself that the motion has gone wrong. How far the tips are from the truth, the suite works
out.
"""

import argparse
import json
import os
import time

# One thread, as our own falling strands have. Libraries read it when they are loaded: import this module first.
os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np

LENGTH = 0.3  # m
GRAVITY = 9.81  # m/s^2
LINEAR_DENSITY = 1.0  # kg/m
RADIUS = LENGTH / 200  # m
FRAMES = 24
# A fall is timed again until this much has gone by, in s, but at least twice and at most so many times.
LONG_ENOUGH = 1.0
MOST_RUNS = 20


class Strand:
    """A strand of so many elements whose weight over its bending stiffness is `gamma`."""

    def __init__(self, elements, gamma):
        self.elements = elements
        self.bending = LINEAR_DENSITY * GRAVITY * LENGTH**3 / gamma  # E I in N m^2
        area_moment = np.pi * RADIUS**4 / 4  # m^4
        self.young = self.bending / area_moment  # Pa
        # Twisting is 2/3 as stiff as bending, and the polar moment of a round section is twice the other.
        self.shear = self.young / 3  # Pa


def arguments():
    """The command line, the same for every script."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--elements", type=int, required=True)
    parser.add_argument("--gamma", type=float, required=True)
    parser.add_argument("--strands", type=int, required=True)
    parser.add_argument("--steps", type=int, nargs="+", required=True, help="steps a frame, one line each")
    return parser.parse_args()


def measure(restart, advance, tip):
    """Falls again and again: the shortest time in s, and the tips of a fall, or None.

    `restart()` goes back to the start, `advance()` on by a frame, False if that went wrong; `tip()` is where the first
    strand ends, in m with y up.
    """
    times, tips = [], []
    while len(times) < 2 or (sum(times) < LONG_ENOUGH and len(times) < MOST_RUNS):
        restart()
        seconds, tips = 0.0, []
        for _ in range(FRAMES):
            start = time.perf_counter()
            went_well = advance()
            seconds += time.perf_counter() - start
            here = np.asarray(tip(), dtype=float) / LENGTH
            if not went_well or not np.isfinite(here).all():
                return seconds, None
            tips.append(here.tolist())
        times.append(seconds)
    return min(times), tips


def report(method, steps, strands, measured):
    """Prints a line of what `measure` found."""
    seconds, tips = measured
    line = {"method": method, "steps": steps, "seconds": seconds / strands, "tips": tips}
    print(json.dumps(line), flush=True)

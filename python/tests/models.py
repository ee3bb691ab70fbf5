"""Models that other processes can import."""

import math
import os
import time

import numpy as np

import sensitol as st


@st.model
def clearance(bore, shaft, tilt):
    return bore - shaft / math.cos(math.radians(tilt))


@st.model(vectorized=True)
def clearance_vectorized(bore, shaft, tilt):
    return bore - shaft / np.cos(np.deg2rad(tilt))


def plain(bore, shaft, tilt):
    return bore - shaft / math.cos(math.radians(tilt))


@st.model
def slow(bore, shaft, tilt):
    time.sleep(0.01)
    return bore - shaft / math.cos(math.radians(tilt))


@st.model
def raising(bore, shaft, tilt):
    raise LookupError("no such part")


@st.model
def dying(bore, shaft, tilt):
    os._exit(3)

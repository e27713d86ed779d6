"""Five performers in one gesture file: keys, a stick, a light, a dancer and a juggler.

The scene of ENACTIVE D.RD3.3.1 §4.5.1: eight piano keys, a 3D stick that places a sound, a 2D
force pad that turns a light, a dancer with sixteen markers and a juggler of a ball with force
feedback, each at its own rate. What they do is made up. Written as GST, read back in blocks.
"""

import numpy as np

from enpointe.motion.gesture import (
    Channel,
    Dimension,
    GestureReader,
    Scene,
    Unit,
    Variable,
    write_scene,
)

keys = tuple(Channel(f"PK{i}", dimension=Dimension.Z, measure="m") for i in range(1, 9))
points = tuple(Channel(f"DP{i}", measure="m") for i in range(1, 17))
balls = (Channel("BL1", measure="m"), Channel("BL2", Variable.ANGLE, Dimension.RQF, "rad"))
units = (
    Unit("Pianist gesture", keys, rate=1000),
    Unit("StickSource", (Channel("SS", measure="m"),), rate=200),
    Unit("Light", (Channel("LS", Variable.FORCE, Dimension.XY, "N"),), rate=400),
    Unit("Dancer", points, rate=120),
    Unit("Juggler", balls, rate=4000),
)
seconds, signals = 1.0, []
for unit in units:
    time = np.arange(seconds * unit.rate) / unit.rate
    signals.append(0.1 * np.sin(2 * np.pi * np.outer(time, 1 + np.arange(unit.width) / 10)))
write_scene(Scene("VR scene", units, tuple(signals)), "five_units.gst")

with GestureReader("five_units.gst") as reader:
    for unit, samples in zip(reader.head.units, reader.head.counts, strict=True):
        kinds = ", ".join(sorted({channel.label.split(" ", 1)[1] for channel in unit.channels}))
        print(f"{unit.name}: {len(unit.channels)} channels {kinds}, {samples} at {unit.rate:g} Hz")
    frames = sum(len(block) for block in reader.blocks(400))
    print(f"{frames} frames of {reader.head.width} tracks at {reader.head.rate:g} Hz")

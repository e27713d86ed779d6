"""Dance a shipped score under gravity, and write its report."""

from pathlib import Path

import enpointe

dance = enpointe.perform("third-port-de-bras", effort="happy")
figures = dance.summary()
print("completed:", figures["completed"])
print("joints behind the score:", f"{figures['tracking_rms_deg']:.2f} degrees")
if (inside := figures["support_margin_min"]) is not None:
    print("centre of mass inside the feet by:", f"{1000 * inside:.0f} mm")

files = enpointe.write_report(dance, Path("out"), video=False)
print("report:", files["report"])

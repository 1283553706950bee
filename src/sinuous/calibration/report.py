"""What a calibration found, as JSON and as rows for people."""

import json

import numpy as np

from sinuous.calibration.calibrate import Calibration
from sinuous.calibration.judge import Judgement

MM = 1e3


def as_json(calibration: Calibration, validation: Judgement | None) -> str:
    """Return the JSON text: SI units, 95 % intervals."""
    identified = calibration.problem.identified
    mismatch = float(identified.mismatch)
    out: dict[str, object] = {
        "robot": calibration.problem.robot.name,
        "motors": [calibration.motors[k] for k in identified.motors],
        "directions": identified.directions.astype(int).tolist(),
        "identified_by_pulls": calibration.pulls_given,
        "identification_mismatch_rad": mismatch if np.isfinite(mismatch) else None,
        "parameters": {name: each.as_json() for name, each in calibration.found.items()},
        "noise_m": calibration.fit.noise.size,
        "noise_memory_rows": calibration.fit.noise.memory,
        "train": calibration.train.as_json(),
    }
    judged = {
        "pulls": calibration.pulls,
        "cross_validation": calibration.cross_validation,
        "from_single_segments": calibration.judge(calibration.from_single),
        "validation": validation,
    }
    out |= {name: each.as_json() for name, each in judged.items() if each is not None}
    return json.dumps(out, indent=1) + "\n"


def rows(calibration: Calibration, validation: Judgement | None) -> list[tuple[str, str]]:
    """Return labels and texts."""
    identified, found = calibration.problem.identified, calibration.found
    names = [calibration.motors[k] for k in identified.motors]
    pulled = [
        f"{'' if d > 0 else '-'}{name}"
        for name, d in zip(names, identified.directions, strict=True)
    ]
    out = [("motors, in the order of the cables", ", ".join(pulled))]
    for name, label, scale, unit in (
        ("hole_radius", "cables from the backbone", MM, "mm"),
        ("effective_pitch", "pitch for kinematics", MM, "mm"),
        ("slack", "slack (pretension below 0)", MM, "mm"),
        ("play", "play", MM, "mm"),
        ("friction", "friction / EI", 1.0, "1/m"),
        ("stiffness_ratio", "cable stiffness / EI", 1.0, "1/m^3"),
        ("marker", "marker", MM, "mm"),
    ):
        value, std = scale * found[name].value, scale * found[name].std
        text = ", ".join(f"{v:.3g} ± {1.96 * s:.2g}" for v, s in zip(value, std, strict=True))
        out.append((label, f"{text} {unit}"))
    judged = (
        ("tip, fitted movements", calibration.train),
        ("tip, single pulls", calibration.pulls),
        ("tip, movements left out", calibration.cross_validation),
        ("tip, several segments from single ones", calibration.judge(calibration.from_single)),
        ("tip, validation", validation),
    )
    out += [(label, _errors(each)) for label, each in judged if each is not None]
    return out


def warnings(calibration: Calibration) -> list[str]:
    """What the user should know: what was missing, and what does not look right."""
    out = list[str]()
    problem = calibration.problem
    if not calibration.pulls_given:
        out.append(
            "without single pulls motors are taken in the order of the cables: if they are not, "
            "or pull different ways, record every cable alone and name that file with --pulls"
        )
    if np.isfinite(problem.identified.mismatch) and problem.identified.mismatch > np.deg2rad(15.0):
        out.append(
            f"cables pull {np.rad2deg(problem.identified.mismatch):.0f} deg from where the robot "
            "file says: are its cable angles right?"
        )
    low, high = problem.parameters.bounds
    x, width = calibration.fit.x, 1e-3 * problem.parameters.spread
    for block in problem.parameters.blocks:
        place = problem.parameters.place(block.name)
        at_end = (x - low < width) | (high - x < width)
        if block.name != "play" and np.any(at_end[place]):
            out.append(f"{block.name} ended at the end of its range: the robot file may be wrong")
    return out


def _errors(judged: Judgement) -> str:
    values = ((judged.rmse, "RMSE"), (judged.mean, "mean"), (judged.worst, "worst"))
    return ", ".join(f"{MM * value:.2f} mm {name}" for value, name in values)

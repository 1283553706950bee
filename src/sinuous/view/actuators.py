"""Which actuators belong together: of one kind in one panel, of one part in one colour."""

import re
from dataclasses import dataclass

PART = re.compile(r"(segment|module) (\d+) ")
NUMBER = re.compile(r"\s*(\d+)$")


@dataclass(frozen=True, kw_only=True)
class Actuator:
    """What the name of an actuator says: "segment 2 cable 3" is cable 3 of segment 2.

    Arguments:
        index: among the robot's actuators
        kind: what it is, such as "cable", "backbone", "insertion"
        segment: the number of its segment or module, 0 if it belongs to none
        number: which of its kind in that part, 0 if there is only one
        part: whether it is a segment or a module
    """

    index: int
    kind: str
    segment: int
    number: int
    part: str = "segment"


def actuator_kinds(names: tuple[str, ...]) -> dict[str, list[Actuator]]:
    """Actuators by kind, in the order in which the kinds occur."""
    kinds: dict[str, list[Actuator]] = {}
    for index, name in enumerate(names):
        part, number = PART.match(name), NUMBER.search(name)
        rest = name[part.end() if part else 0 : number.start() if number else None]
        actuator = Actuator(
            index=index,
            kind=rest or "actuator",
            segment=int(part[2]) if part else 0,
            number=int(number[1]) if number else 0,
            part=part[1] if part else "segment",
        )
        kinds.setdefault(actuator.kind, []).append(actuator)
    return kinds

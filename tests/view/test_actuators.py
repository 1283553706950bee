from sinuous.view.actuators import Actuator, actuator_kinds


def test_names_tell_kind_segment_and_number() -> None:
    names = ("insertion", "segment 1 cable 1", "segment 1 cable 2", "segment 1 backbone")
    assert actuator_kinds(names) == {
        "insertion": [Actuator(index=0, kind="insertion", segment=0, number=0)],
        "cable": [
            Actuator(index=1, kind="cable", segment=1, number=1),
            Actuator(index=2, kind="cable", segment=1, number=2),
        ],
        "backbone": [Actuator(index=3, kind="backbone", segment=1, number=0)],
    }


def test_modules_are_parts_like_segments() -> None:
    kinds = actuator_kinds(("module 1 cable 3", "module 12 cable 1"))
    assert kinds == {
        "cable": [
            Actuator(index=0, kind="cable", segment=1, number=3, part="module"),
            Actuator(index=1, kind="cable", segment=12, number=1, part="module"),
        ]
    }


def test_names_of_other_robots_are_kinds_of_their_own() -> None:
    kinds = actuator_kinds(("left motor", "7", "rod 2", "segmented 3"))
    assert {kind: [a.number for a in members] for kind, members in kinds.items()} == {
        "left motor": [0],
        "actuator": [7],
        "rod": [2],
        "segmented": [3],
    }

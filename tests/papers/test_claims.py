"""Every verdict follows from data: with the right data it holds, with others it does not."""

import copy
import json
from collections.abc import Callable
from typing import Any

import pytest

from sinuous.papers.claims import Claim, rows
from sinuous.papers.hachen2025.claims import CLAIMS

Data = dict[str, Any]


def respond(controller: str, **changes: Any) -> Data:
    """A row of III-C in which everything is as the paper says."""
    return {
        "controller": controller,
        "tip_error_at_rest_m": 0.002 if controller == "MPC + local" else 0.004,
        "tip_error_from_disturbance_m": 0.005,
        "nominal_error_final_m": 0.0,
        "settling_time_s": 1.0,
        "approach_linearity": 0.99,
        "local_error_before_draws_m": 0.0001 if controller == "MPC + local" else 0.004,
        "local_error_at_rest_m": 0.002,
        "body_error_at_rest_m": 0.001,
    } | changes


def pass_through(scene: str, controller: str, *, disturbed: bool = False) -> Data:
    """A row of III-D in which everything is as the paper says."""
    return {
        "scene": scene,
        "controller": controller,
        "disturbed": disturbed,
        "margin_m": 0.003,
        "steps": 100,
        "nominal_violations": 0,
        "least_nominal_clearance_m": 0.0031,
        "least_actual_clearance_m": 0.0031,
        "nominal_error_at_waypoints_m": [1e-6, 1e-6],
        "bend_at_the_end_rad": 3.0,
        "fastest_actuator": 1.0,
        "fastest_tip_m_s": 0.06,
        "tip_speed_limit_m_s": 0.06,
    }


def held(test: str, controller: str, **changes: Any) -> Data:
    """A row of section IV in which everything is as the paper says."""
    return {
        "test": test,
        "controller": controller,
        "margin_m": 0.0055,
        "nominal_violations": 0,
        "nominal_error_at_goals_m": [1e-6, 1e-6],
        "real_error_at_goals_m": [0.001, 0.001],
        "local_error_at_goals_m": [0.001, 0.02 if test == "slack" else 0.001],
        "local_input_at_goals_m_s": [0.001, 0.001],
        "least_tip_room_m": 0.004,
        "least_actual_clearance_m": 0.003,
        "curves": {"nominal_input_m_s": [0.01, 0.013]},
    } | changes


def as_the_paper_says() -> Data:
    """Data of all experiments with which every claim holds."""
    dls = ("DLS, printed gains", "DLS, best gains")
    return {
        "printed": {
            "restart": {
                "printed_tip_error_m": [0.06, 0.03, 0.0],
                "ours_tip_error_m": [0.06, 0.03, 0.0],
            },
            "cost": {"printed, S = 10": [0.06, 1e-6], "ours": [0.06, 1e-6]},
            "penalty": {"printed": [1.0, 0.5], "ours": [1.0, 0.5]},
            "smoothness": [
                {"horizon": 2, "roughness": 0.3},
                {"horizon": 5, "roughness": 0.2},
                {"horizon": 10, "roughness": 0.1},
            ],
        },
        "convergence": {
            "rows": [
                respond(name)
                for name in (*dls, "MPC alone", "MPC + local", "MPC offset-free")
                for _ in range(3)
            ]
        },
        "waypoints": {
            "rows": [
                *(
                    pass_through(scene, name)
                    for scene in ("winding_tube", "inverted_u")
                    for name in ("MPC", *dls)
                ),
                *(
                    pass_through("winding_tube", name, disturbed=True)
                    for name in ("MPC alone", "MPC + local")
                ),
            ]
        },
        "stability": {
            "oscillating_above_m": 0.0005,
            "turns_back": 2.0,
            "gains": dict.fromkeys(dls),
            "rows": [
                {"controller": dls[0], "extent_m": 0.01, "path_m": 0.2},
                {"controller": dls[1], "extent_m": 0.0, "path_m": 0.0},
                {"controller": "MPC", "extent_m": 0.0001, "path_m": 0.001},
            ],
        },
        "unreachable": {
            "margin_m": 0.003,
            "speed_m_s": 0.01,
            "dt_s": 0.03,
            "rest": [
                {
                    "controller": name,
                    "projected": False,
                    "outside_m": 0.02,
                    "clearance_at_rest_m": 0.003 if name == "MPC" else -0.01,
                }
                for name in ("MPC", *dls)
            ],
            "sweeps": [
                {"sweep": "U", "controller": "MPC", "projected": True, "aim_jump_m": 0.05,
                 "tip_jump_in_window_m": 0.04},
                {"sweep": "U", "controller": "MPC", "projected": False, "aim_jump_m": 0.0,
                 "tip_jump_in_window_m": 0.001},
            ],
        },
        "timing": {
            "rows": [
                {
                    "controller": "sinuous",
                    "constrained": walls,
                    "horizon": N,
                    "mean_s": 0.002,
                    "p99_s": 0.01 if N <= 2 else 0.04,
                }
                for walls in (False, True)
                for N in range(1, 7)
            ]
        },
        "hardware": {
            "rows": [
                held(test, name)
                for test in ("goals", "slack", "boundary")
                for name in ("MPC + local", "MPC + local, offset-free")
            ]
        },
    }  # fmt: skip


def every(experiment: str, key: str, value: object, **wanted: object) -> Callable[[Data], None]:
    """Change a value in all rows that have the wanted values."""

    def change(data: Data) -> None:
        changed = [
            row
            for row in data[experiment]["rows"]
            if all(row[name] == v for name, v in wanted.items())
        ]
        assert changed
        for row in changed:
            row[key] = value

    return change


def put(value: object, *path: str | int) -> Callable[[Data], None]:
    """Change a single value."""

    def change(data: Data) -> None:
        place: Any = data
        for step in path[:-1]:
            place = place[step]
        place[path[-1]] = value

    return change


FLIPS: dict[str, list[Callable[[Data], None]]] = {
    "restart": [put([0.06, 0.06, 0.06], "printed", "restart", "printed_tip_error_m")],
    "steady_error": [put([0.06, 0.002], "printed", "cost", "printed, S = 10")],
    "penalty_sign": [put([1.0, 30.0], "printed", "penalty", "printed")],
    "smoother_with_longer_horizons": [put(0.4, "printed", "smoothness", 2, "roughness")],
    "convergence_under_disturbances": [
        put(0.008, "convergence", "rows", 0, "tip_error_at_rest_m"),
        every("convergence", "nominal_error_final_m", 1e-4, controller="MPC + local"),
    ],
    "same_convergence_time": [
        every("convergence", "settling_time_s", 2.0, controller="DLS, printed gains")
    ],
    "better_tracking": [
        every("convergence", "tip_error_at_rest_m", 0.001, controller="DLS, best gains"),
        every("convergence", "tip_error_at_rest_m", 0.006, controller="MPC + local"),
    ],
    "linear_approach": [every("convergence", "approach_linearity", 0.8)],
    "local_error_vanishes": [
        every("convergence", "local_error_before_draws_m", 0.002, controller="MPC + local")
    ],
    "body_error": [every("convergence", "body_error_at_rest_m", 0.0021, controller="MPC + local")],
    "obstacles_as_constraints": [put(1, "waypoints", "rows", 0, "nominal_violations")],
    "both_reach_the_waypoints": [
        put([1e-6, 0.002], "waypoints", "rows", 1, "nominal_error_at_waypoints_m"),
        put(-0.001, "waypoints", "rows", 1, "least_actual_clearance_m"),
    ],
    "inverted_u": [
        put([1e-6, 0.002], "waypoints", "rows", 3, "nominal_error_at_waypoints_m"),
        put(1, "waypoints", "rows", 3, "nominal_violations"),
    ],
    "efficient_shape": [put(4.0, "waypoints", "rows", 0, "bend_at_the_end_rad")],
    "dls_is_unstable_somewhere": [put(0.011, "stability", "rows", 0, "path_m")],
    "mpc_is_stable": [put(0.001, "stability", "rows", 2, "extent_m")],
    "margin_at_unreachable_targets": [put(0.0029, "unreachable", "rest", 0, "clearance_at_rest_m")],
    "dls_violates": [put(0.001, "unreachable", "rest", 1, "clearance_at_rest_m")],
    "projection_is_volatile": [put(0.001, "unreachable", "sweeps", 0, "aim_jump_m")],
    "true_target_is_calmer": [put(0.0005, "unreachable", "sweeps", 0, "tip_jump_in_window_m")],
    "limits_are_kept": [
        put(1.001, "waypoints", "rows", 0, "fastest_actuator"),
        put(0.061, "waypoints", "rows", 0, "fastest_tip_m_s"),
    ],
    "mean_time": [put(0.031, "timing", "rows", 7, "mean_s")],
    "time_bounds": [
        put(0.1, "timing", "rows", 4, "mean_s"),
        put(0.1, "timing", "rows", 8, "mean_s"),
    ],
    "two_is_the_limit": [
        put(0.03, "timing", "rows", 8, "p99_s"),
        put(0.04, "timing", "rows", 7, "p99_s"),
    ],
    "nominal_reaches_its_goals": [
        put([1e-6, 0.01], "hardware", "rows", 0, "nominal_error_at_goals_m")
    ],
    "slack_leaves_an_error": [
        put([0.001, 0.001], "hardware", "rows", 2, "local_error_at_goals_m"),
        put([0.001, 0.02], "hardware", "rows", 0, "local_error_at_goals_m"),
    ],
    "boundary_is_held": [
        put(1, "hardware", "rows", 4, "nominal_violations"),
        put(0.002, "hardware", "rows", 4, "least_tip_room_m"),
        put(-0.001, "hardware", "rows", 5, "least_actual_clearance_m"),
    ],
    "speeds_are_kept": [put([0.02], "hardware", "rows", 0, "curves", "nominal_input_m_s")],
}
NAMED = {claim.name: claim for claim in CLAIMS}
OPEN = {"prototype"}  # no simulation can tell


def test_every_claim_has_its_own_name_and_can_flip() -> None:
    assert len(NAMED) == len(CLAIMS)
    assert NAMED.keys() == FLIPS.keys() | OPEN


@pytest.mark.parametrize("name", FLIPS)
def test_a_claim_holds_with_data_that_say_so(name: str) -> None:
    verdict = NAMED[name].verdict(as_the_paper_says())
    assert verdict.holds is True
    assert verdict.measured


@pytest.mark.parametrize(
    ("name", "number"), [(name, k) for name, flips in FLIPS.items() for k in range(len(flips))]
)
def test_a_claim_does_not_hold_with_data_that_say_otherwise(name: str, number: int) -> None:
    data = as_the_paper_says()
    FLIPS[name][number](data)
    assert NAMED[name].verdict(data).holds is False


@pytest.mark.parametrize("name", OPEN)
def test_what_cannot_be_told_stays_open_with_a_reason(name: str) -> None:
    verdict = NAMED[name].verdict(as_the_paper_says())
    assert verdict.holds is None
    assert verdict.reason


def test_nobody_is_compared_with_who_left_the_zone() -> None:
    data = as_the_paper_says()
    for row in data["waypoints"]["rows"]:
        if row["controller"].startswith("DLS"):
            row["least_actual_clearance_m"] = -0.001
    assert NAMED["efficient_shape"].verdict(data).holds is None


def test_verdicts_come_from_data_alone_and_do_not_change_them() -> None:
    data = as_the_paper_says()
    before = copy.deepcopy(data)
    first = rows(CLAIMS, json.loads(json.dumps(data)))
    assert first == rows(CLAIMS, data)
    assert data == before


def test_a_claim_whose_experiment_did_not_run_stays_open() -> None:
    data = as_the_paper_says()
    del data["stability"]
    for claim in CLAIMS:
        verdict = claim.verdict(data)
        if claim.name not in OPEN:
            assert (verdict.holds is None) == ("stability" in claim.needs)
            assert verdict.holds is not None or "stability did not run" in verdict.reason


def test_rows_say_where_a_verdict_comes_from() -> None:
    row = next(r for r in rows(CLAIMS, as_the_paper_says()) if r["id"] == "mpc_is_stable")
    assert row["data"] == ["data/stability.json"]
    assert str(row["verdict"]).endswith("claims.constraints.mpc_is_stable")
    assert isinstance(NAMED["mpc_is_stable"], Claim)

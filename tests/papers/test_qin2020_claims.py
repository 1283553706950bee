"""Paper A: with the right data every verdict holds, with others it does not."""

import copy
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.papers.claims import rows
from sinuous.papers.qin2020.claims import CLAIMS
from sinuous.papers.qin2020.paper import QIN2020

Data = dict[str, Any]
OMEGA = np.linspace(0.01, 60.0, 3000)


def kinematics() -> Data:
    """Data of 2.2 in which everything is as the paper says."""
    return {
        "disc": {
            "chi_rad": 0.35,
            "targets": 100,
            "tip_error_m": 1e-16,
            "tube_tilt_rad": 1e-16,
            "within_limit_share": 1.0,
            "largest_bend_rad": 0.6,
            "bend_limit_rad": 0.68,
            "moved_before_k_rad": 0.0,
            "share_by_k": [0.5, 0.3, 0.2],
        },
        "by_chi": [
            {
                "chi_rad": chi,
                "radius_m": 0.26,
                "within_limit_share": 1.0,
                "square_share": 1.0,
            }
            for chi in (0.3, 0.35)
        ],
        "holes": {
            "poses": 10,
            "median_m": 0.0,
            "largest_m": 0.0,
            "straight_by_module_m": [0.0, 0.0],
            "round_trip_rad": 1e-15,
            "wrong_by_m": 0.001,
            "residual_m": [0.0003, 0.0004],
        },
        "links": {"printed_median_m": 0.0, "printed_largest_m": 1e-15, "ours_largest_m": 1e-15},
        "plane": {
            "width_of_printed_points_m": 0.1,
            "length_of_printed_points_m": 0.3,
            "without_point_in_the_plane_share": 0.0,
            "farther_intersection": [{"nearer_m": 0.0, "farther_m": 0.1}],
        },
        "times": {
            "at_once_mean_s": 1e-6,
            "one_by_one_median_s": 2e-6,
            "one_by_one_p99_s": 3e-6,
            "solvers": [
                {"solver": "sinuous", "median_us": 1.0, "p99_us": 2.0, "solved": 1.0},
                {"solver": "DLS", "median_us": 2000.0, "p99_us": 5000.0, "solved": 1.0},
                {"solver": "CCD", "median_us": 3000.0, "p99_us": 6000.0, "solved": 1.0},
            ],
        },
    }


def scattering() -> Data:
    """Data of Fig. 8 in which everything is as the paper says."""
    gains = (0.3, 0.49, 0.5, 0.8, 1.0, 2.0)
    return {
        "fig8": {
            "omega_rad_s": OMEGA.tolist(),
            "norm": {
                "K = 0.6": (0.96 - 0.03 * np.cos(2.0 * OMEGA)).tolist(),
                "K = 0.6, no low-pass": np.ones_like(OMEGA).tolist(),
            },
            "period_rad_s": np.pi,
            "mean_by_period": [0.97, 0.95, 0.93],
            "largest_by_period": [1.0, 0.98, 0.96],
        },
        "sweep": [
            {
                "gain": gain,
                "combinations": 96,
                "largest_norm": 1.2 if gain < 0.5 else 1.0 + 1e-15,
            }
            for gain in gains
        ],
        "delays": [
            {"delay_s": T, "largest_norm": 1.2, "least_passive_gain": 0.5} for T in (0.0, 0.2, 1.0)
        ],
        "impedances": [
            {
                "impedance_n_s_m": b,
                "largest_norm_below": 1.1 if b < 10.0 else 1.0,
                "largest_norm_at_half": 1.0,
            }
            for b in (1.0, 10.0)
        ],
    }


def channel() -> Data:
    """Energies in time in which everything is as the paper says."""
    exact = {"equation_20": 1e-15, "equation_21": 1e-16}
    return {
        "rows": [
            {"scheme": "K = 0.3", "least_j": -20.0, **exact},
            {"scheme": "K = 0.49", "least_j": -0.1, **exact},
            {"scheme": "K = 0.5", "least_j": 0.0, **exact},
            {"scheme": "standard waves", "least_j": 0.0},
        ]
    }


def contact(axis: str, side: float) -> Data:
    """A contact as the paper says."""
    return {
        "axis": axis,
        "side": side,
        "step_n": 0.05,
        "rest_virtual_n": 0.5,
        "rest_felt_n": 0.5001,
    }


def session(name: str, scheme: str, hand: str) -> Data:
    """A run of section 4 in which everything is as the paper says."""
    force = 0.4 if scheme == "C1" else 0.2
    errors = {
        "force_n": force,
        "tracking_m": 0.005,
        "tracking_largest_m": 0.01,
        "following_m": 0.02,
        "virtual_n": 0.5,
    }
    return {
        "set": name,
        "scheme": scheme,
        "hand": hand,
        "real_time_factor": 10.0,
        "range_m": [0.25, 0.22],
        "all": dict(errors),
        "free": dict(errors),
        "contact": dict(errors),
        "faults": 0,
        "least_energy_j": {"channel_j": 0.0, "follower_j": -1e-9},
        "largest_free_step_n": 0.002,
        "felt_beside_21_n": 1e-16,
        "contacts": [contact(axis, side) for axis in "xz" for side in (1.0, -1.0)],
        "force_error_n": [[2.0 * force, -force], [0.0, force]] if hand == "trajectory" else None,
    }


def signs() -> Data:
    """Forces as the paper says."""
    error = np.linspace(-0.04, 0.04, 81)
    return {
        "error": {
            "error_m": error.tolist(),
            "force_n": (1.5 * np.tanh(error / 0.02)).tolist(),
            "length_m": 0.01,
            "gain_n": 3.0,
            "unscaled_n": (0.75 * error).tolist(),
        },
        "point": [
            {"force": force, "side": side, "farthest_m": 0.19}
            for force in ("printed", "ours")
            for side in ("upper", "lower")
        ],
        "chain": [
            {"force": force, "side": "upper", "desired_farthest_m": 0.2}
            for force in ("printed", "ours")
        ],
        "damper": [
            {"force": force, "side": side, "force_n": 0.1, "resists": True}
            for force in ("printed", "ours", "scalar")
            for side in ("upper", "lower")
        ],
        "damping": [
            {
                "damping_n_s_m": damping,
                "largest_force_n": 1.0,
                "swing_at_rest_n": 0.1,
                "least_follower_j": -0.1,
            }
            for damping in (1.0, 100.0)
        ],
    }


def transparency() -> Data:
    """The trade-off as the paper says."""
    return {
        "rows": [
            {"impedance_n_s_m": b, "gain": K, "velocity_m_s": 0.2 / b, "force_n": 0.05 * K * b}
            for b in (5.0, 10.0, 20.0)
            for K in (0.5, 1.0)
        ],
        "waiting": [{"waiting_n": 0.0}, {"waiting_n": 1e-17}],
        "felt": {
            name: {"width_when_slow": width}
            for name, width in (("C1", 2.0), ("C2", 4.0), ("standard waves", 20.0))
        },
    }


def as_the_paper_says() -> Data:
    """Data of all experiments with which every claim holds."""
    cases = ("as printed", "clamped", "clamped, corrected", "lost", "lost, corrected")
    return {
        "kinematics": kinematics(),
        "scattering": scattering(),
        "channel": channel(),
        "sets": {
            "rows": [
                session(name, scheme, hand)
                for name in ("set1", "set2")
                for scheme in ("C1", "C2")
                for hand in ("impedance", "trajectory")
            ]
        },
        "signs": signs(),
        "transparency": transparency(),
        "drift": {
            "at_rest": [
                {"velocity_error_m_s": 1e-9, "offset_m": -0.04, "theory_m": -0.04},
            ],
            "runs": [{"case": case, "last_offset_m": 0.0} for case in cases],
        },
    }


def put(value: object, *path: str | int) -> Callable[[Data], None]:
    """Change a single value."""

    def change(data: Data) -> None:
        place: Any = data
        for step in path[:-1]:
            place = place[step]
        assert place[path[-1]] != value
        place[path[-1]] = value

    return change


def row(name: str, scheme: str, hand: str = "impedance") -> int:
    """Where a run of section 4 is among the rows."""
    return (
        4 * ("set1", "set2").index(name)
        + 2 * ("C1", "C2").index(scheme)
        + ("impedance", "trajectory").index(hand)
    )


def every_plane_misses(data: Data) -> None:
    for plane in data["kinematics"]["by_chi"]:
        plane["square_share"] = 0.76


K, S, X = "kinematics", "scattering", "sets"
FLIPS: dict[str, list[Callable[[Data], None]]] = {
    "hole_angle": [put([0.0, 0.003], K, "holes", "straight_by_module_m")],
    "unique_angles": [put(1e-3, K, "holes", "round_trip_rad")],
    "geometric_solution": [
        put(1e-6, K, "disc", "tip_error_m"),
        put(1e-6, K, "disc", "tube_tilt_rad"),
    ],
    "fewest_joints": [put(0.01, K, "disc", "moved_before_k_rad")],
    "plane_of_13": [put(1e-17, K, "plane", "width_of_printed_points_m")],
    "directions_of_14": [put(0.01, K, "links", "printed_largest_m")],
    "boundary_can_be_reached": [every_plane_misses],
    "real_time": [put(0.002, K, "times", "one_by_one_p99_s")],
    "iteration_is_too_slow": [put(9.0, K, "times", "solvers", 1, "p99_us")],
    "transmission": [
        put(0.01, "channel", "rows", 2, "equation_20"),
        put(0.01, "channel", "rows", 1, "equation_21"),
    ],
    "norm_below_one": [put(1.001, S, "sweep", 3, "largest_norm")],
    "figure_8": [
        put((0.98 - 0.03 * np.cos(2.0 * OMEGA)).tolist(), S, "fig8", "norm", "K = 0.6"),
        put((0.96 - 0.03 * np.cos(3.0 * OMEGA)).tolist(), S, "fig8", "norm", "K = 0.6"),
    ],
    "filter_reduces_the_norm": [
        put([0.97, 0.95, 0.951], S, "fig8", "mean_by_period"),
        put([1.0, 0.98, 0.98], S, "fig8", "largest_by_period"),
    ],
    "delay_is_only_periodic": [put(1.0, S, "delays", 0, "largest_norm")],
    "impedance_affects_passivity": [put(1.01, S, "impedances", 1, "largest_norm_below")],
    "guaranteed_stability": [
        put(-0.1, "channel", "rows", 2, "least_j"),
        put(-0.1, "channel", "rows", 3, "least_j"),
        put(-0.1, X, "rows", 5, "least_energy_j", "channel_j"),
        put(1, X, "rows", 0, "faults"),
    ],
    "follower_is_passive": [put(-0.1, X, "rows", 0, "least_energy_j", "follower_j")],
    "sensitive_force": [
        put(1.4, "signs", "error", "gain_n"),
        put((1.5 * np.linspace(-1, 1, 81) ** 3).tolist(), "signs", "error", "force_n"),
    ],
    "printed_signs": [put(1e20, "signs", "point", 1, "farthest_m")],
    "damper_on_both_sides": [put(False, "signs", "damper", 5, "resists")],
    "desired_velocity": [put(0.01, "drift", "at_rest", 0, "velocity_error_m_s")],
    "exact_at_rest": [put(0.1, "transparency", "waiting", 1, "waiting_n")],
    "trade_off": [
        put(0.05, "transparency", "rows", 2, "velocity_m_s"),
        put(0.01, "transparency", "rows", 5, "force_n"),
    ],
    "secondary_parameter": [
        put(0.03, "transparency", "rows", 1, "velocity_m_s"),
        put(0.2, "transparency", "rows", 1, "force_n"),
    ],
    "improved_transparency": [put(1.0, "transparency", "felt", "C2", "width_when_slow")],
    "follows_closely": [put(0.03, X, "rows", row("set1", "C2"), "free", "tracking_largest_m")],
    "tracking_alike": [put(0.007, X, "rows", row("set2", "C2"), "all", "tracking_m")],
    "better_force": [
        put(0.39, X, "rows", row("set1", "C2"), "free", "force_n"),
        put([[0.5, -0.2], [0.0, 0.2]], X, "rows", row("set1", "C2", "trajectory"), "force_error_n"),
    ],
    "better_force_in_contact": [
        put(0.39, X, "rows", row("set2", "C2"), "contact", "force_n"),
        put([[0.5, -0.2], [0.0, 0.2]], X, "rows", row("set2", "C2", "trajectory"), "force_error_n"),
    ],
    "boundary_is_felt": [
        put([], X, "rows", row("set2", "C1"), "contacts"),
        put(0.004, X, "rows", row("set2", "C2"), "contacts", 3, "step_n"),
        put(0.01, X, "rows", row("set2", "C2"), "contacts", 0, "rest_felt_n"),
        put(0.4, X, "rows", row("set2", "C1"), "contacts", 1, "rest_virtual_n"),
    ],
    "real_time_chain": [put(0.9, X, "rows", 3, "real_time_factor")],
}  # fmt: skip
NAMED = {claim.name: claim for claim in CLAIMS}
OPEN = {"prototype", "perception"}  # no simulation can tell
CONTRARY = {"no_analytic_solution": put(0.1, K, "disc", "tip_error_m")}
"""What cannot hold where the geometric solution does."""


def test_every_claim_has_its_own_name_and_can_flip() -> None:
    assert len(NAMED) == len(CLAIMS)
    assert NAMED.keys() == FLIPS.keys() | OPEN | CONTRARY.keys()


def test_every_claim_finds_its_data() -> None:
    names = [one.name for one in QIN2020.experiments]
    assert len(names) == len(set(names))
    assert {name for claim in CLAIMS for name in claim.needs} <= set(names)


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


@pytest.mark.parametrize("name", CONTRARY)
def test_a_claim_that_another_one_refutes(name: str) -> None:
    data = as_the_paper_says()
    assert NAMED[name].verdict(data).holds is False
    CONTRARY[name](data)
    assert NAMED[name].verdict(data).holds is True


@pytest.mark.parametrize("name", sorted(OPEN))
def test_what_cannot_be_told_stays_open_with_a_reason(name: str) -> None:
    verdict = NAMED[name].verdict(as_the_paper_says())
    assert verdict.holds is None
    assert verdict.reason


def test_verdicts_come_from_data_alone_and_do_not_change_them() -> None:
    data = as_the_paper_says()
    before = copy.deepcopy(data)
    first = rows(CLAIMS, json.loads(json.dumps(data)))
    assert first == rows(CLAIMS, data)
    assert data == before


def test_a_claim_whose_experiment_did_not_run_stays_open() -> None:
    data = as_the_paper_says()
    del data["sets"]
    for claim in CLAIMS:
        verdict = claim.verdict(data)
        if claim.name not in OPEN:
            assert (verdict.holds is None) == ("sets" in claim.needs)
            assert verdict.holds is not None or "sets did not run" in verdict.reason

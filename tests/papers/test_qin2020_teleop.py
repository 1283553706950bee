"""Paper A, 3 and 4: passivity, signs, transparency, drift, and the sets, on both sides."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.cli import main
from sinuous.papers.qin2020 import channel, drift, rigs, scattering, transparency
from sinuous.papers.qin2020.runs import BOUNDARY, DELAY, inverse, scenario
from sinuous.papers.qin2020.sets import experiment as sets
from sinuous.papers.qin2020.sets.signals import Signals
from sinuous.papers.qin2020.signs import experiment as signs
from sinuous.teleop.analysis.hybrid import hybrid_matrix
from sinuous.teleop.analysis.scattering import scattering_norm

ROUNDING = 1e-12

# --- scattering and energy --------------------------------------------------------------------


@pytest.mark.parametrize("delay", [0.01, 0.2, 1.0])
def test_the_least_passive_gain_is_where_the_norm_crosses_one(delay: float) -> None:
    omega = np.linspace(0.02, 60.0, 3000)
    least = scattering._delay(delay, omega)["least_passive_gain"]
    assert 0.25 <= least < 0.5
    for gain, passive in ((least + 1e-3, True), (least - 1e-3, False)):
        H = hybrid_matrix(omega, gain=gain, impedance=10.0, cutoff=20.0, delay=delay)
        assert (np.max(scattering_norm(H)) <= 1.0 + scattering.ROUNDING) == passive


def test_the_printed_curve_is_periodic_and_below_one() -> None:
    found = scattering._fig8(1500)
    norm = np.array(found["norm"]["K = 0.6"])
    assert 1.0 - 1e-6 < np.max(norm) <= 1.0 + scattering.ROUNDING
    assert np.min(norm) == pytest.approx(0.9030, abs=2e-4)
    bare = np.array(found["norm"]["K = 0.6, no low-pass"])
    assert np.all(np.diff(found["mean_by_period"]) < 0.0)
    assert np.ptp(bare) > 0.05  # without the low-pass it goes to and fro, and does not fall
    assert np.max(bare[-400:]) == pytest.approx(1.0, abs=1e-4)
    assert np.max(found["norm"]["K = 0.49"]) > 1.001


def test_a_gain_below_a_half_loses_energy_and_the_terms_add_up() -> None:
    rows = {
        name: channel.drive((name, 0.2, channel.WORST, 20.0)) for name in ("K = 0.3", "K = 0.5")
    }
    assert rows["K = 0.3"]["least_j"] < -10.0
    assert rows["K = 0.3"]["omega_rad_s"] == pytest.approx(6.74, abs=0.02)
    assert rows["K = 0.5"]["least_j"] == 0.0
    for row in rows.values():
        for identity in ("power_identity", "equation_20", "equation_21"):
            assert row[identity] < ROUNDING
    random = channel.drive(("K = 0.3", 0.2, channel.RANDOM, 5.0))
    assert random["least_j"] == 0.0  # random inputs do not show it
    assert "equation_20" not in channel.drive((channel.STANDARD, 0.2, channel.RANDOM, 1.0))


# --- signs ------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", ["upper", "lower"])
def test_with_the_printed_signs_a_point_runs_away(side: str) -> None:
    lost, kept = (signs.push_point((force, side, 8.0)) for force in ("printed", "ours"))
    assert lost["farthest_m"] > 1e3
    assert lost["beyond_a_metre_s"] < 5.0
    assert BOUNDARY < kept["farthest_m"] < 0.2
    assert kept["beyond_a_metre_s"] is None
    assert np.sign(kept["last_m"]) == signs.SIDES[side]


@pytest.mark.parametrize("side", ["upper", "lower"])
def test_the_arm_is_bounded_by_its_length_but_where_it_should_be_is_not(side: str) -> None:
    lost, kept = (signs.push_arm((force, side, 4.0)) for force in ("printed", "ours"))
    assert lost["desired_farthest_m"] > 0.35
    assert kept["desired_farthest_m"] < 0.2
    for row in (lost, kept):
        assert np.sign(row["last_m"]) == signs.SIDES[side]
        assert row["farthest_m"] < 0.21


def test_a_number_for_a_damper_resists_on_one_side_only() -> None:
    resists = {
        (name, side): signs._damper(name, side)["resists"]
        for name in ("ours", "scalar", "printed")
        for side in signs.SIDES
    }
    assert all(resists["ours", side] for side in signs.SIDES)
    for name in ("scalar", "printed"):
        assert resists[name, "upper"] != resists[name, "lower"]


def test_a_mirrored_scenario_starts_on_the_other_side_and_goes_there() -> None:
    base = sets.chain("set2", "C2", "impedance", seconds=3.0)
    turned = signs.mirrored(base)
    for time in (0.0, 1.3, 3.0):
        there, here = turned.path[0].at(time), base.path[0].at(time)
        np.testing.assert_allclose(there, here * (1.0, 1.0, -1.0))
    tip = inverse().robot.tip(turned.first_configuration)
    np.testing.assert_allclose(tip, turned.path[0].at(0.0), atol=1e-9)


# --- transparency and drift -------------------------------------------------------------------


def test_the_tour_stops_everywhere_and_never_jumps() -> None:
    time = np.arange(0.0, transparency.DURATION, 0.01)
    way = np.array([transparency.tour(one) for one in time])
    speed = np.linalg.norm(np.diff(way, axis=0), axis=1) / 0.01
    assert np.max(speed) < 0.2
    assert np.mean(speed == 0.0) > 0.5
    ends = [transparency.tour(k * 4.5 - 1e-6) for k in range(1, 6)]
    np.testing.assert_allclose(ends, np.array(transparency.STOPS) / 2.25, atol=1e-12)


def test_b_trades_velocity_for_force_and_gain_touches_the_force_alone() -> None:
    soft, hard, high = (
        transparency.same_motion(item) for item in ((5.0, 0.5, 6.0), (20.0, 0.5, 6.0),
                                                    (5.0, 1.0, 6.0))
    )  # fmt: skip
    assert hard["velocity_m_s"] < soft["velocity_m_s"]
    assert hard["force_n"] == pytest.approx(4.0 * soft["force_n"], rel=1e-9)
    assert high["velocity_m_s"] == pytest.approx(soft["velocity_m_s"], rel=1e-9)
    assert high["force_n"] == pytest.approx(2.0 * soft["force_n"], rel=1e-9)
    assert transparency.move_and_wait((10.0, 0.5, 3.0))["waiting_n"] < ROUNDING


@pytest.mark.parametrize("scheme", ["C1", "C2"])
def test_at_rest_in_contact_the_offset_is_what_theory_says(scheme: str) -> None:
    row = drift.at_rest((scheme, 0.22))
    assert row["force_n"] > 0.5
    assert row["velocity_error_m_s"] < 1e-6
    assert row["offset_m"] == pytest.approx(row["theory_m"], rel=0.003)  # a tick of 450


def test_what_is_clamped_or_lost_stays_away_unless_it_is_corrected() -> None:
    rows = {case: drift.there_and_back((case, 20.0)) for case in drift.CASES}
    assert abs(rows["as printed"]["last_offset_m"]) < 1e-6
    for case in ("clamped", "lost"):
        assert abs(rows[case]["last_offset_m"]) > 0.02
        assert abs(rows[f"{case}, corrected"]["last_offset_m"]) < 1e-3
    for row in rows.values():
        assert row["least_channel_j"] >= -ROUNDING


def test_a_push_starts_and_ends_at_rest() -> None:
    way = rigs.push([0.0, 0.225], after=1.0, lasting=2.0)
    np.testing.assert_array_equal(way(0.5), [0.0, 0.0])
    np.testing.assert_allclose(way(2.0), [0.0, 0.05])
    np.testing.assert_allclose(way(5.0), [0.0, 0.1])


# --- the sets ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def beginnings() -> dict[tuple[str, str], dict[str, Any]]:
    """The first seconds of Set 2 with the whole chain: the first contact."""
    return {
        (scheme, hand): json.loads(json.dumps(sets.drive(("set2", scheme, hand, True))))
        for scheme, hand in (("C1", "trajectory"), ("C2", "trajectory"), ("C2", "impedance"))
    }


def test_on_the_same_motion_the_force_error_is_half(
    beginnings: dict[tuple[str, str], dict[str, Any]],
) -> None:
    one, two = (beginnings[scheme, "trajectory"] for scheme in ("C1", "C2"))
    assert two["all"]["force_n"] / one["all"]["force_n"] == pytest.approx(0.5, abs=1e-9)
    first, second = (np.array(row["force_error_n"]) for row in (one, two))
    np.testing.assert_allclose(second, 0.5 * first, atol=ROUNDING)
    assert np.max(np.abs(first)) > 0.5


def test_the_boundary_is_felt_one_delay_later(
    beginnings: dict[tuple[str, str], dict[str, Any]],
) -> None:
    for row in beginnings.values():
        (contact,) = row["contacts"]
        assert (contact["axis"], contact["side"]) == ("z", 1.0)
        assert contact["step_n"] > 5.0 * row["largest_free_step_n"]
        assert contact["depth_m"] > 0.005
        assert contact["rest_felt_n"] == pytest.approx(contact["rest_virtual_n"], abs=0.005)
        assert contact["rest_virtual_n"] > 0.3
        assert row["felt_beside_21_n"] < ROUNDING
        assert row["faults"] == 0
        assert row["least_energy_j"]["channel_j"] >= -ROUNDING
    step = beginnings["C1", "trajectory"]["contacts"][0]
    assert step["step_felt_n"] == pytest.approx(step["step_n"], abs=0.03)


def test_every_set_starts_in_its_plane_within_the_joint_limits() -> None:
    ik = inverse()
    for name, chi in (("set1", 19.5), ("set2", 22.5)):
        found = scenario(name)
        (leg,) = found.path
        times = np.arange(0.0, leg.moving, 0.1)
        way = np.array([leg.at(float(time)) for time in times])
        assert found.teleop is not None
        assert found.teleop.table.mapping.depth == pytest.approx(way[0, 1], abs=1e-6)
        assert np.degrees(ik.chi(float(way[0, 1]))) == pytest.approx(chi, abs=1e-3)
        assert np.min(found.robot.bend_slack(found.first_configuration)) > 0.0
        np.testing.assert_allclose(found.robot.tip(found.first_configuration), way[0], atol=1e-9)
        assert found.teleop.table.delay == DELAY
        beyond = np.max(np.abs(way[:, [0, 2]])) > BOUNDARY
        assert beyond == (name == "set2")


def made_up() -> Signals:
    """Two seconds: the follower is beyond z = 0.18 from 0.5 s to 1 s, but for a moment."""
    dt, count, late = 1e-3, 2000, 200
    time = dt * np.arange(count)
    z = np.where((time >= 0.5) & (time < 1.0) & (np.abs(time - 0.7) > 0.01), 0.19, 0.1)
    F_s = np.stack([np.zeros(count), 50.0 * np.maximum(z - 0.18, 0.0)], axis=1)
    V = np.stack([np.cos(time), np.zeros(count)], axis=1)
    X_s = np.stack([np.zeros(count), z], axis=1)
    F_m = 5.0 * V
    F_m[late:] += F_s[:-late]
    return Signals(dt=dt, late=late, X=X_s + 0.01, V=V, X_sd=X_s + 0.003, X_s=X_s, F_s=F_s, F_m=F_m)


def test_numbers_of_made_up_signals() -> None:
    found = made_up()
    np.testing.assert_allclose(found.force_error, 5.0 * found.V, atol=ROUNDING)
    (contact,) = found.contacts(BOUNDARY)
    assert (contact["axis"], contact["side"]) == ("z", 1.0)
    assert contact["from_s"] == pytest.approx(0.5)
    assert contact["to_s"] == pytest.approx(0.999)
    assert contact["step_n"] == pytest.approx(0.5)
    assert contact["step_felt_n"] == pytest.approx(0.5, abs=1e-9)
    assert contact["offset_m"] == pytest.approx(0.007)
    everywhere = found.errors(np.ones(2000, dtype=np.bool_))
    assert everywhere["tracking_m"] == pytest.approx(0.003 * np.sqrt(2.0))
    assert everywhere["force_n"] == pytest.approx(5.0 * np.sqrt(np.mean(found.V[:, 0] ** 2)))
    assert found.errors(np.zeros(2000, dtype=np.bool_))["force_n"] == 0.0
    free = ~np.any(found.beyond(BOUNDARY), axis=1)
    assert found.largest_step(free) == 0.0
    assert found.largest_step(np.ones(2000, dtype=np.bool_)) == pytest.approx(0.5)


def test_one_experiment_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = main([
        "reproduce", "qin2020", "--out", str(tmp_path), "--quick", "--only", "scattering",
        "--processes", "1",
    ])  # fmt: skip
    assert code == 0
    assert "never exceeds one" in capsys.readouterr().out
    written = json.loads((tmp_path / "claims.json").read_text())["claims"]
    claims = {row["id"]: row for row in written}
    assert claims["norm_below_one"]["holds"] is True
    assert claims["impedance_affects_passivity"]["holds"] is False
    assert claims["better_force"]["holds"] is None
    for name in ("fig8_scattering_norm", "passive_region"):
        assert (tmp_path / "figures" / "scattering" / f"{name}.png").stat().st_size > 10_000

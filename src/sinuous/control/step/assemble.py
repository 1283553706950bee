"""Makes the records of a model in compiled code, where alone they can be made."""

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
from sinuous.control.step.data import Aims, Bends, Body, Limits, Model, Rules, Scale
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.grid import Grid
from sinuous.robots.pcc_kernels import Chain


@kernel
def body(
    chain: Chain, T_w_b: Array, required: Array, movable: BoolArray, zone: ZoneArrays, grid: Grid
) -> Body:
    return Body(chain, T_w_b, required, movable, zone, grid)


@kernel
def bends(theta: IntArray, slope: Array, offset: Array, pitch: Array) -> Bends:
    return Bends(theta, slope, offset, pitch)


@kernel
def limits(
    A: Array,
    b: Array,
    scaled: Array,
    first: IntArray,
    last: IntArray,
    low: Array,
    high: Array,
    slowest: Array,
    fastest: Array,
    trust: float,
    tip_step: float,
) -> Limits:
    return Limits(A, b, scaled, first, last, low, high, slowest, fastest, trust, tip_step)


@kernel
def aims(tip: float, posture: float, Q: Array, q: Array, E: Array, home: Array) -> Aims:
    return Aims(tip, posture, Q, q, E, home)


@kernel
def scale(step: float, metric: Array, inverse: Array, Q: Array, E: Array) -> Scale:
    return Scale(step, metric, inverse, Q, E)


@kernel
def rules(reserve: float, near: float, rounds: int, late: float) -> Rules:
    return Rules(reserve, near, rounds, late)


@kernel
def model(
    body: Body, bends: Bends, limits: Limits, aims: Aims, scale: Scale, rules: Rules
) -> Model:
    return Model(body, bends, limits, aims, scale, rules)

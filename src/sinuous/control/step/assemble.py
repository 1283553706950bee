"""Makes the records of a model in compiled code, where alone they can be made."""

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
from sinuous.control.step.data import Aims, Bends, Body, Limits, Model, Rules, Scale
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.grid import Grid
from sinuous.robots.chain_kernels import Chain
from sinuous.robots.routing import Routing


@kernel
def body(
    chain: Chain, T_w_b: Array, required: Array, movable: BoolArray, zone: ZoneArrays, grid: Grid
) -> Body:
    return Body(chain, T_w_b, required, movable, zone, grid)


@kernel
def bends(
    column: IntArray, is_joint: BoolArray, slope: Array, offset: Array, pitch: Array
) -> Bends:
    return Bends(column, is_joint, slope, offset, pitch)


@kernel
def limits(
    routing: Routing,
    own: IntArray,
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
    return Limits(routing, own, scaled, first, last, low, high, slowest, fastest, trust, tip_step)


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

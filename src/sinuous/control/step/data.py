"""What a compiled step reads, and its scratch: arrays in named tuples, all in SI units.

The solver works in y = M delta / s, changes of the actuators counted in the largest step s, so
that all its numbers are of order one whatever the robot's size and rate.
"""

from typing import NamedTuple

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.control.step.rows import Iterate, Pairs, Rows
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.grid import Grid
from sinuous.records import record
from sinuous.robots.chain_kernels import Chain
from sinuous.robots.routing import Routing

# Soft rows of one stage: more are not kept. What is left out joins when a solution violates it,
# and the safety filter has the last word.
SOFT = 64

# Contacts of one stage that the next step remembers, the strongest.
CONTACTS = 16


@record
class Body:
    """The robot's body and the walls around it.

    Arguments:
        chain: kinematics
        T_w_b: base in the world (4, 4)
        required: distance that guarded points keep (S,) [m]
        movable: which of them any actuator moves (S,)
        zone, grid: the walls
    """

    chain: Chain
    T_w_b: Array
    required: Array
    movable: BoolArray
    zone: ZoneArrays
    grid: Grid


@record
class Bends:
    """Bend limits pitch (slope c + offset - bend) >= 0, in cable travel; see `robots.bending`.

    Arguments:
        column: first of the two coordinates that bend it (J,)
        is_joint: whether they are the angles of a universal joint (J,)
        slope: (J, n)
        offset: (J,) [rad]
        pitch: (J,) [m]
    """

    column: IntArray
    is_joint: BoolArray
    slope: Array
    offset: Array
    pitch: Array


@record
class Limits:
    """Limits of what a configuration is worth, and of its change: lengths, then coordinates.

    Arguments:
        routing: the lengths of the actuators (P,)
        own: columns of the limited coordinates (K - P,)
        scaled: J M^-1 with the derivative J of the limited values at home (K, n)
        first, last: span of its rows, anywhere (K,)
        low, high: of the values (K,) [m]
        slowest, fastest: change of the lengths in one step (P,) [m]
        trust: largest change of a length from its prediction [m]
        tip_step: largest way of the tip in one step [m]
    """

    routing: Routing
    own: IntArray
    scaled: Array
    first: IntArray
    last: IntArray
    low: Array
    high: Array
    slowest: Array
    fastest: Array
    trust: float
    tip_step: float


@record
class Aims:
    """Costs: tip |p - target|^2 + posture |P M (c - home)|^2 + 1/2 c' Q c + q' c, 1/2 v' E v.

    Arguments:
        tip, posture: weights
        Q, q: (n, n), (n,)
        E: (n, n), of the increments
        home: (n,)
    """

    tip: float
    posture: float
    Q: Array
    q: Array
    E: Array
    home: Array


@record
class Scale:
    """delta = s M^-1 y.

    Arguments:
        step: s [m]
        metric, inverse: M and M^-1 (n, n)
        Q, E: s^2 M^-T (.) M^-1 (n, n)
    """

    step: float
    metric: Array
    inverse: Array
    Q: Array
    E: Array


@record
class Rules:
    """Numbers that steer the plan; see `mpc`.

    Arguments:
        reserve: what plans keep on top of the required distance [m]
        near: points so close to where they must stop get a plane from the start [m]
        rounds: of solving and adding planes
        late: how much more later stages may violate before they are corrected [m]
    """

    reserve: float
    near: float
    rounds: int
    late: float


@record
class Model:
    """All that stays the same from step to step."""

    body: Body
    bends: Bends
    limits: Limits
    aims: Aims
    scale: Scale
    rules: Rules


@record
class Shape:
    """Shapes of the body at several configurations, and how much room they have.

    Arguments:
        c: (B, n)
        points: (B, S, 3) [m]
        clearance: (B, S) [m], exact or a lower bound
        exact: whether it is (B, S)
        gradient: of the exact ones (B, S, 3)
        slot: of their nearest triangle (B, S)
    """

    c: Array
    points: Array
    clearance: Array
    exact: BoolArray
    gradient: Array
    slot: IntArray


@record
class Motion:
    """Derivatives of the kinematics at the predicted stages; see `chain_kernels`.

    Arguments:
        R, p: frames of the sections (N, M + 1, 3, 3), (N, M + 1, 3)
        ends, spins: how they move (N, M, 3, 3), (N, M, 3, 2)
        tip: Jacobian of the tip by y (N, 3, n)
        free: projector on the null space of the tip, in y (N, n, n)
    """

    R: Array
    p: Array
    ends: Array
    spins: Array
    tip: Array
    free: Array


@record
class Meaning:
    """What the rows of the QP stand for (m,).

    Arguments:
        what: one of `STATE_LIMIT`, `RATE_LIMIT`, `TIP_SPEED`, `WALL`, `BEND`
        index: of the limit, or of the body point of a wall plane
        slot: of the wall's triangle, else -1
        normal: direction in which it pushes (m, 3)
        value: factor from a multiplier to [cost / m]
        size: norm of the row before it was scaled [m]
    """

    what: IntArray
    index: IntArray
    slot: IntArray
    normal: Array
    value: Array
    size: Array


STATE_LIMIT, RATE_LIMIT, TIP_SPEED, WALL, BEND = 0, 1, 2, 3, 4


@record
class Problem:
    """The QP of a step.

    Arguments:
        H, f: of the stages (N, n, n), (N, n)
        E: of the increments (n, n)
        rows, meaning: conditions, the hard ones first
        strength: multipliers of the last solution [cost / m] (m,)
    """

    H: Array
    f: Array
    E: Array
    rows: Rows
    meaning: Meaning
    strength: Array


@record
class Scratch:
    """Small arrays that every part may use and none may rely on.

    Arguments:
        stack, keys: for queries of the zone
        R, p: frames of one configuration (M + 1, 3, 3), (M + 1, 3)
        J: (3, n)
        row: (n,)
        square, other: (n, n)
        number: (S,)
        amount: (S,)
        force: (S + 1, 3)
        second: scratch of `chain_second.curvature`
        small: vectors and a matrix of space (5, 3)
    """

    stack: IntArray
    keys: Array
    R: Array
    p: Array
    J: Array
    row: Array
    square: Array
    other: Array
    number: IntArray
    amount: Array
    force: Array
    second: Array
    small: Array


class Contacts(NamedTuple):
    """Walls that the stages of the last plan leaned on.

    Arguments:
        number: of every stage (N,)
        point: body points (N, K)
        slot: triangles (N, K)
        push: of the walls on the points [cost / m] (N, K, 3)
    """

    number: IntArray
    point: IntArray
    slot: IntArray
    push: Array


@record
class Way:
    """What the safety filter looks at between two shapes.

    Arguments:
        c: one configuration (n,)
        points: of the body at equal shares of the way (B, S, 3) [m]
        ready: which of them are filled (B,)
        clearance: of one of the points at these shares, or a lower bound [m] (B,)
        pieces: of the way that are still to be judged (B, 2)
    """

    c: Array
    points: Array
    ready: BoolArray
    clearance: Array
    pieces: IntArray


@record
class Work:
    """All scratch of a step: where it starts, the old stages, those found, and where it ends."""

    start: Shape
    old: Shape
    found: Shape
    end: Shape
    way: Way
    motion: Motion
    problem: Problem
    pairs: Pairs
    iterate: Iterate
    scratch: Scratch

"""The operator's side: a device in a real hand, both ends of the channel, the link between them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.gizmo import Gizmo
from sinuous.leaders.leader import Hand, Leader
from sinuous.live.live_link import LiveLink
from sinuous.live.orders import Aim, HandOrder, PageLost, Pause, Resume, SetFeel, SetLink
from sinuous.live.path_hand import hand_axes
from sinuous.scenario.link_tables import LinkTable
from sinuous.scenario.links import link_of
from sinuous.scenario.teleop import Teleoperation
from sinuous.scenario.teleop_tables import TeleopTable, WavesTable
from sinuous.session.by_hand import ENERGIES
from sinuous.teleop.bilateral import Bilateral, BilateralState, Signals
from sinuous.teleop.kernels import work
from sinuous.teleop.motion import NO_WALLS, Walls


class Tick(NamedTuple):
    """What a tick of the operator's side comes to.

    Arguments:
        target: for the tip (3,) [m]
        hand: as the device says
        felt: the force on the hand (3,) [N]
        stiffness: of walls [N/m]
        share: by which the leader's end takes part
        signals: as they are recorded, see `session.by_hand` (C,)
    """

    target: Array
    hand: Hand
    felt: Array
    stiffness: float
    share: float
    signals: Array


class HandSide:
    """Both ends of a teleoperation, with a device instead of a model of the operator.

    Its time is counted in ticks; only the device may know another one.

    Arguments:
        teleop: what is between hand and robot
        tip: where the robot's tip starts (3,) [m]
        leader: the device
    """

    def __init__(self, teleop: Teleoperation, tip: Array, leader: Leader) -> None:
        self._leader, self._dt = leader, teleop.dt
        self._axes = hand_axes(len(teleop.axes))
        self._ticks = self._before = 0
        self._read_at = 0.0
        self._hand = leader.read(0.0)
        self._energies = np.zeros(len(ENERGIES))
        self.least = 0.0
        self.paused = False
        self._next: TeleopTable | None = None
        self._obey: dict[type, Callable[[Any], None]] = {
            Aim: self._aim,
            PageLost: self._page_lost,
            Pause: self._pause,
            Resume: self._resume,
            SetLink: self._set_link,
            SetFeel: self._set_feel,
        }
        self._install(teleop, tip, np.zeros(len(teleop.axes)), running=True)

    def _install(
        self, teleop: Teleoperation, tip: Array, position: Array, *, running: bool
    ) -> None:
        """Begin with parts that are new, at rest where the tip is and the hand at (A,) [m]."""
        self._teleop, self._mapping = teleop, teleop.mapping
        self._before = self._ticks
        self._bilateral: Bilateral[Any] = teleop.bilateral(self._goal, ())
        state = self._bilateral.init(tip, running=running)
        self._zero = state.leader.x - position
        links = [LiveLink(self._bilateral.forward, 0), LiveLink(self._bilateral.backward, 1)]
        self._links, self._longest = links, _longest(teleop.table)
        self._state: BilateralState[Any] = state._replace(forward=links[0], backward=links[1])

    @property
    def waits(self) -> bool:
        """Whether hand and robot part, or are apart, for parts to be changed."""
        return self._next is not None

    def obey(self, order: HandOrder) -> None:
        """Do what is asked, from the next tick on."""
        self._obey[type(order)](order)

    def tick(self, tip: Array, walls: Walls = NO_WALLS) -> Tick:
        """One tick, given the measured tip (3,) [m] and the walls that its controller knows of."""
        if self._next is not None and self._apart:
            table, self._next = self._next, None
            position = self._hand.position[self._axes]
            self._install(replace(self._teleop, table=table), tip, position, running=False)
            self._join()
        self._read(self._ticks * self._dt)
        if not self._hand.connected and not self.paused:
            self._pause(Pause())
        self._state, signals = self._bilateral.step(self._state, tip, walls)
        self._ticks += 1
        felt = np.zeros(3)
        felt[self._axes] = -signals.leader.F_m
        self._leader.feel(felt)
        return Tick(
            signals.follower.target_w,
            self._hand,
            felt,
            self._teleop.table.force.stiffness,
            self._state.leader.share,
            self._row(signals),
        )

    def rest(self) -> None:
        """Simulated time stands: the hand feels nothing."""
        self._leader.feel(np.zeros(3))

    @property
    def _apart(self) -> bool:
        return self._state.leader.share == 0.0 == self._state.follower.share

    def _read(self, time: float) -> None:
        if time > self._read_at:
            self._hand, self._read_at = self._leader.read(time), time

    def _goal(self, time: float) -> Array:
        """Where the hand is (A,) [m], for the operator who holds the device there."""
        self._read(self._before * self._dt + time if self._before else time)
        return self._zero + self._hand.position[self._axes]

    def _row(self, signals: Signals) -> Array:
        _, a, b = signals
        out = self._dt * work(b.F_s, b.V_sd)
        felt, hand = self._dt * work(a.F_m, a.V), self._dt * work(a.F_h, a.V)
        self._energies = self._energies + np.array([felt - out, -hand, out])
        self.least = min(self.least, float(self._energies[0]))
        vectors = (a.x, a.F_h, a.F_m, a.X, a.V, b.X_sd, b.V_sd, b.X_s, b.F_s)
        fault = float(bool(a.fault) + bool(b.fault))
        return np.concatenate([*vectors, self._energies, [fault]])

    def _aim(self, order: Aim) -> None:
        if isinstance(self._leader, Gizmo):  # another device is where it is
            x = self._mapping.project(order.target) / self._mapping.scale
            position = np.zeros(3)
            position[self._axes] = x - self._zero
            self._leader.aim(position, order.stamp)

    def _page_lost(self, order: PageLost) -> None:
        if isinstance(self._leader, Gizmo):
            self._leader.lost()

    def _pause(self, order: Pause) -> None:
        self.paused = True
        self._state = self._bilateral.pause(self._state)

    def _resume(self, order: Resume) -> None:
        self.paused = False
        if not self.waits:
            self._join()

    def _join(self) -> None:
        if not self.paused:
            self._state = self._bilateral.resume(self._state)

    def _set_link(self, order: SetLink) -> None:
        link = LinkTable(jitter=order.jitter, loss=order.loss)
        table = replace(self._teleop.table, delay=order.delay, link=link)
        if self._next is not None:
            self._next = replace(self._next, delay=order.delay, link=link)
        seed = self._teleop.seed + self._ticks  # else the same luck would come again
        model = link_of(link, delay=order.delay, trace=None, seed=seed, dt=self._dt)
        for one in self._links:
            one.become(model, self._longest)
        self._longest = _longest(table)
        self._teleop = replace(self._teleop, table=table)

    def _set_feel(self, order: SetFeel) -> None:
        table = self._next or self._teleop.table
        waves, force = table.waves, table.force
        if order.scheme is not None and order.scheme is not table.scheme:
            waves = WavesTable(impedance=waves.impedance)  # gain and cutoff are those of one scheme
        if order.impedance is not None:
            waves = replace(waves, impedance=order.impedance)
        self._next = replace(
            table,
            scheme=table.scheme if order.scheme is None else order.scheme,
            waves=waves,
            force=replace(
                force,
                gain=force.gain if order.gain is None else order.gain,
                stiffness=force.stiffness if order.stiffness is None else order.stiffness,
            ),
        )
        self._state = self._bilateral.pause(self._state)


def _longest(table: TeleopTable) -> float:
    """Time after which a packet has arrived, if ever [s]."""
    link = table.link or LinkTable()
    return table.delay + link.jitter + max((late for _, late in link.course), default=0.0)

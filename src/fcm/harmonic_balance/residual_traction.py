r"""How far a peak ranges with the residual traction of the contacts that stick all through the cycle.

The slider of such a contact may rest anywhere between its slip limits, and a motion belongs to each place.
The balance is of contacts that begin unstressed. With the mean friction t of those that stick, a peak changes
by

    dA = sum_i g_i . dt_i,    |k_u u~_i + t_i| <= mu n_i  at every angle

so that it changes most where each t_i is at its limit, along g_i or against it. Both members of the family
are balanced exactly, the limits those of their own motion, and their peaks found. As g changes on the way,
this is an estimate and no bound; where g has turned at the end, the limits along the new one are tried, too.

On a line t_i is a number and its limits an interval; in a plane it is a vector, within what all discs share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.continuation.corrector import Newton
from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.dense_jacobian import answer, jacobian_of
from fcm.harmonic_balance.line_contact import Periodic
from fcm.harmonic_balance.planar_contact import Planar
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

BoolArray = npt.NDArray[np.bool_]
_End = tuple[float, float, FloatArray]  # of a stretch of a curve: length, slope of the amplitude, point


@dataclass(frozen=True)
class TractionOptions:
    """How the members of a family are come to.

    far : float
        Where the slider begins that comes to rest at its limit, in the size of its motion and its limits.
    felt : float
        Part of the greatest derivative, below which a contact's traction is left as it is.
    shorter, longer, shortest : float
        Times a step that the next is, where it led to no motion, and where it did, along the curve and on the
        way to the limits; and the part of that way below which none does.
    rounds : int
        Times that the limits are sought along the derivatives at the member found last.
    turned : float
        Part of the tractions that have to go to other limits for another round.
    step, looks, height : float, int, float
        First length along the curve, points at most, and relative accuracy of the height, of a peak.
    beside : float
        A peak counts to that of another degree of freedom where the amplitude is at least this part of it.
    most : int
        Peaks of a curve that are looked at one by one.
    """

    far: float = 10.0
    felt: float = 1e-9
    shorter: float = 0.25
    longer: float = 2.0
    shortest: float = 1e-4
    rounds: int = 3
    turned: float = 1e-2
    step: float = 1e-2
    looks: int = 40
    height: float = 1e-6
    beside: float = 0.9
    most: int = 4


TRACTION = TractionOptions()


class Begun(Law):
    """A contact that began elsewhere than unstressed: its slider rests there, or as near as its limits allow.

    start (direction,): the tangential displacement at which it began.
    """

    def __init__(self, law: Periodic | Planar) -> None:
        super().__init__(law.width, law.directions, law.margins, law.mu, law.k_u, law.k_v, law.n_0)
        self.kernel, self.start = law.kernel, np.zeros(law.directions - 1)
        self.force, self.tangent = np.zeros(law.width), law.kernel.jacobian
        self.without_margins()

    def evaluate(self, x: FloatArray, first: int) -> int:
        """Forces and tangent."""
        block = np.ascontiguousarray(np.asarray(x)[first : first + self.width])
        self.kernel.at(block, self.mu, self.k_u, self.k_v, self.n_0, *self.start.tolist())
        self.force[:] = self.kernel.forces
        self.force[self.directions - 1] -= max(self.n_0, 0.0)
        return 0


class _Members:
    """A balance whose contacts begin where they are told to, and its peaks from a given one on.

    start (contact, direction) is what is asked for; that of contacts which do not always stick has no effect.
    """

    def __init__(self, system: System, options: TractionOptions) -> None:
        self.system, self.options = system, options
        self.balance: Balance = system.balance()
        self.begun = [Begun(law) for law in system.exact_laws(system.harmonics)]  # type: ignore[arg-type]
        self.balance.laws = list(self.begun)
        self.newton = Newton(self.balance)
        self.scale = np.ones(self.balance.unknowns + 1)

    def put(self, start: FloatArray) -> None:
        for law, one in zip(self.begun, start, strict=True):
            law.start[:] = one

    def solved(self, guess: FloatArray, row: FloatArray) -> FloatArray | None:
        """The point in the plane across a row, in scaled coordinates; the tangent is then that there."""
        self.system.work.poll()
        newton = self.newton
        newton.scale[:], newton.z[:], newton.row[:] = self.scale, guess, row
        if not newton.correct(1.0):
            return None
        point = np.array(newton.z)
        return point if newton.take_tangent() else None

    def heights(self, z: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Amplitudes (dof,) at a point, and their growth along a direction in scaled coordinates."""
        self.balance.evaluate(z)
        self.balance.report(z, np.ascontiguousarray(direction * self.scale))
        return np.array(self.balance.output), np.array(self.balance.growth)

    def begin(self, z: FloatArray, edge: bool) -> FloatArray | None:
        """The direction of the curve at a point; that of the frequency at the end of a range."""
        self.balance.measure(z)
        self.scale = np.array(self.balance.scale)
        row = np.eye(z.size)[-1]
        return row if self.solved(z, row) is None or edge else np.array(self.newton.tangent)

    def top(self, z: FloatArray, row: FloatArray, dof: int) -> FloatArray | None:
        """The peak of a degree of freedom next to a point, uphill on the curve as far as the range goes."""
        low, high = self.system.scene.frequency_range
        options, here = self.options, self.solved(z, row)
        if here is None:
            return None
        ahead, length = np.array(self.newton.tangent), options.step
        up = self.heights(here, ahead)[1][dof]
        if up < 0.0:
            ahead, up = -ahead, -up
        for _ in range(options.looks):
            point = self.solved(here + length * self.scale * ahead, ahead)
            if point is None:
                length *= options.shorter
                continue
            tangent = np.array(self.newton.tangent)
            growth = self.heights(point, tangent)[1][dof]
            if growth > 0.0 and not low <= point[-1] <= high:
                point[-1] = min(max(point[-1], low), high)
                return self.solved(point, np.eye(point.size)[-1])
            if growth <= 0.0:
                return self._between(here, ahead, (0.0, up, here), (length, growth, point), dof)
            here, ahead, up, length = point, tangent, growth, length * options.longer
        return None

    def _between(self, here: FloatArray, ahead: FloatArray, low: _End, high: _End, dof: int) -> FloatArray:
        """The peak between two points at lengths along a direction, by their slopes: the Illinois method."""
        last = 0
        for _ in range(self.options.looks):
            (a, up, _), (b, down, _) = low, high
            at = a + (b - a) * up / (up - down)
            point = self.solved(here + at * self.scale * ahead, ahead)
            if point is None:
                break
            height, growth = self.heights(point, np.array(self.newton.tangent))
            side = 1 if growth[dof] > 0.0 else -1
            if side > 0:
                low, high = (at, growth[dof], point), (b, 0.5 * down if last == side else down, high[2])
            else:
                low, high = (a, 0.5 * up if last == side else up, low[2]), (at, growth[dof], point)
            last = side
            if abs(growth[dof]) * (high[0] - low[0]) < self.options.height * height[dof]:
                break
        peak = max((low[2], high[2]), key=lambda one: self.heights(one, ahead)[0][dof])
        self.solved(peak, ahead)  # for the tangent there
        return peak

    def derivatives(self, z: FloatArray, row: FloatArray, ports: npt.NDArray[np.intp]) -> FloatArray:
        """Of the amplitudes by the mean friction forces at some ports, (port, dof), along a row."""
        balance, scale = self.balance, self.scale
        balance.evaluate(z)
        force = np.zeros((balance.unknowns, ports.size))
        force[np.asarray(balance.layout.mean_at)[ports], np.arange(ports.size)] = 1.0
        right = np.concatenate((-answer(balance, force) / scale[:-1, None], np.zeros((1, ports.size))))
        if balance.rank:
            balance.factor(row, scale)
            for column in right.T:
                whole = np.ascontiguousarray(column)
                balance.solve(whole)
                column[:] = whole
        else:
            matrix = np.concatenate((jacobian_of(balance) * scale / scale[:-1, None], row[None]))
            right[:] = np.linalg.solve(matrix, right)
        found = np.zeros((ports.size, balance.outputs))
        for k, direction in enumerate(right.T):
            balance.report(z, np.ascontiguousarray(direction * scale))
            found[k] = balance.growth
        return found


class _Family:
    """The members of the family of one peak whose tractions are at their limits."""

    def __init__(self, members: _Members, z: FloatArray, stuck: BoolArray, dof: int, edge: bool) -> None:
        self.members, self.options, self.dof, self.edge = members, members.options, dof, edge
        self.contacts = np.flatnonzero(stuck)
        directions = members.system.layout.directions
        each = directions * self.contacts[:, None] + np.arange(directions - 1)
        self.ports, self.along = each.ravel(), directions - 1
        contacts = [members.system.scene.contacts[i] for i in self.contacts]
        on_line = np.array([[False] + [c.second is None] * (self.along - 1) for c in contacts])
        self.fixed = on_line.ravel()  # directions that a contact has not, beside others in a plane
        self.z, self.row = z, members.begin(z, edge)
        self.none = np.zeros((len(members.begun), self.along))

    def change(self) -> FloatArray:
        """By how much the amplitudes (dof,) change at most, relative; NaN where no motion was found."""
        members = self.members
        members.put(self.none)
        base = None if self.row is None else self._top(self.z, self.row)
        if base is None or self.row is None:
            return np.full(members.balance.outputs, np.nan)
        row = self.row if self.edge else np.array(members.newton.tangent)
        before = members.heights(base, row)[0]
        most = np.zeros(before.size)
        for sense in (1.0, -1.0):
            after = self._extreme(base, row, sense)
            if after is None:
                return np.full(before.size, np.nan)
            most = np.maximum(most, np.abs(after - before) / np.where(before > 0.0, before, 1.0))
        return most

    def _top(self, z: FloatArray, row: FloatArray) -> FloatArray | None:
        return self.members.solved(z, row) if self.edge else self.members.top(z, row, self.dof)

    def _extreme(self, base: FloatArray, row: FloatArray, sense: float) -> FloatArray | None:
        """Amplitudes (dof,) of the member with the greatest, or the least, peak."""
        members, z, begin = self.members, base, self.none
        members.put(begin)
        best = members.heights(base, row)[0]
        for _ in range(self.options.rounds):
            limits = self._limits(z, row, sense, begin)
            if limits is None:
                break
            found = self._moved(z, row, begin, limits)
            if found is None:
                return None
            z, begin = found, limits
            row = row if self.edge else np.array(members.newton.tangent)
            height = members.heights(z, row)[0]
            if sense * (height[self.dof] - best[self.dof]) <= 0.0:
                break
            best = height
        return best

    def _limits(self, z: FloatArray, row: FloatArray, sense: float, begin: FloatArray) -> FloatArray | None:
        """Where sliders begin that come to rest at the limits of steepest change; None if they do already."""
        members, layout = self.members, self.members.system.layout
        slopes = members.derivatives(z, row, self.ports)[:, self.dof]
        slopes[self.fixed] = 0.0
        by = sense * slopes.reshape(-1, self.along)
        size = np.linalg.norm(by, axis=1)
        weight = size * np.array([self._reach(i, z) for i in self.contacts.tolist()])
        height = abs(members.heights(z, row)[0][self.dof])
        moves = (size > 0.0) & (weight > self.options.felt * height)
        if not moves.any():
            return None
        limits = begin.copy()
        for k in np.flatnonzero(moves).tolist():
            i = int(self.contacts[k])
            mean = z[layout.mean_at].reshape(-1, layout.directions)[i, :-1]
            far = self.options.far * self._reach(i, z) / members.begun[i].k_u
            limits[i] = mean - far * by[k] / size[k]
        if begin is self.none:
            return limits
        ahead = [float(by[k] @ (begin[self.contacts[k]])) for k in np.flatnonzero(moves)]
        return limits if float(np.mean(np.array(ahead) > 0.0)) > self.options.turned else None

    def _reach(self, i: int, z: FloatArray) -> float:
        """A force that the friction of a contact does not exceed."""
        law, layout = self.members.begun[i], self.members.system.layout
        x = np.abs(layout.blocks(z[None])[0, i])
        normal = x[layout.directions - 1] + x[layout.directions :].sum()
        return float(law.mu * (abs(law.n_0) + law.k_v * normal) + law.k_u * x.sum())

    def _moved(self, z: FloatArray, row: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray | None:
        """The peak with sliders that begin elsewhere, in as many steps as it takes."""
        members, done, share = self.members, 0.0, 1.0
        while done < 1.0:
            reach = min(done + share, 1.0)
            members.put(begin + reach * (end - begin))
            found = self._top(z, row)
            if found is None:
                share *= self.options.shorter
                if share < self.options.shortest:
                    return None
                continue
            z, done, share = found, reach, share * self.options.longer
            row = row if self.edge else np.array(members.newton.tangent)
        return z


def peak_changes(
    system: System,
    z: FloatArray,
    amplitude: FloatArray,
    top: npt.NDArray[np.intp],
    stuck: BoolArray,
    options: TractionOptions = TRACTION,
) -> FloatArray:
    """By how much peaks (dof,) change with residual tractions, relative to each; an estimate, see the module.

    Parameters
    ----------
    system : System
    z : (point, unknown + 1)
        Of a curve; where a peak is at an end of the scene's range, its frequency is held.
    amplitude : (point, dof)
    top : (dof,)
        The points at which the peaks are.
    stuck : (dof, contact)
        Whether a contact sticks all through the cycle there, and another may feel it.
    options : TractionOptions, optional

    Returns
    -------
    (dof,)
        0 where nothing sticks that matters; NaN where no such motion was found, or there are too many peaks.

    Examples
    --------
    A contact that sticks presses on nothing else, so that its traction changes no peak:

    >>> import fcm, numpy as np
    >>> system = System(fcm.load_scene("yang1998-n5"))
    >>> z, none = np.zeros((1, system.layout.unknowns + 1)), np.zeros((2, 1), dtype=bool)
    >>> peak_changes(system, z, np.ones((1, 2)), np.zeros(2, dtype=int), none).tolist()
    [0.0, 0.0]
    """
    own = amplitude[top, np.arange(top.size)]
    edge = np.isin(z[top, -1], system.scene.frequency_range)
    found = np.where(stuck.any(axis=1) & (own > 0.0), np.nan, 0.0)
    members, left = None, options.most
    for d in np.argsort(-own, kind="stable").tolist():
        if not np.isnan(found[d]) or not left:
            continue
        members = members or _Members(system, options)
        change = _Family(members, z[top[d]], stuck[d], d, bool(edge[d])).change()
        near = np.isnan(found) & (amplitude[top[d]] >= options.beside * own) & (edge == edge[d])
        found[near], left = change[near], left - 1
        if np.isnan(change[d]):
            break
    return found

r"""Range of a peak over the residual tractions of the contacts that stick through the whole cycle.

The slider of such a contact may rest anywhere between its slip limits, and each position has its own motion.
The balance itself assumes contacts that begin unstressed, or with the friction of [start]. With the mean
friction t of the contacts that stick, a peak changes by

    dA = sum_i g_i . dt_i,    |k_u u~_i + t_i| <= mu n_i  at every angle

so that it changes most where each t_i is at its limit, along g_i or against it. These two members of the
family are balanced exactly, with the limits and the g of their own motion, and their peaks are computed.
Other members may differ more: this is an estimate and no bound.

Where everything else is linear, the peak is the same for every t and g is zero, until another contact opens,
closes or slips. Then g is that of the mean load of the contact that comes nearest to such a change.

A member's curve ends where those contacts begin to slip. The peak may lie at this end, a corner of the curve;
so may the peak of the original motion.

On a line t_i is a number and its limits are an interval. In a plane t_i is a vector in the intersection of
the discs of all angles.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.contact_kernel import ContactParameters
from fcm.continuation.corrector import Newton
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_law import KernelLaw, Law
from fcm.harmonic_balance.dense_jacobian import apply_compliance, jacobian_of
from fcm.harmonic_balance.residual import Balance
from fcm.harmonic_balance.system import System
from fcm.model.scene import Contact, FloatArray

BoolArray = npt.NDArray[np.bool_]
_End = tuple[float, float, FloatArray]  # of a stretch of a curve: length, slope of the amplitude, point


class TractionOptions(Frozen):
    """Options on how the members of a family of motions with other residual tractions are found.

    start_distance : initial distance of a slider, relative to its motion and its limits, from which it comes
        to rest at its limit.
    min_change : change of the peak by the tractions, relative to the peak, below which they are ignored.
    min_factor, max_factor, min_step : factor on a step that failed; factor on one that succeeded, along the
        curve and towards the limits; and step, relative to the distance to the limits, below which there is
        no member.
    max_members : most steps towards the limits: near a corner of the curve steps may stay short.
    max_rounds : most times that the limits are computed, with motion and derivatives of the last member.
    traction_tolerance : distance of a traction from its limit, relative to the greatest traction, that is
        accepted.
    stick_tolerance : difference of the forces of a contact from those of its springs, relative to these, up
        to which it always sticks.
    initial_step, max_points, peak_tolerance : first step along the curve, most points, and relative accuracy
    of
        the height, in the search for a peak.
    peak_threshold : amplitude of another degree of freedom at a peak, relative to its own peak, from which on
        the same change holds for both.
    max_peaks : most peaks of a curve that are computed.
    """

    start_distance: float = 10.0
    min_change: float = 1e-9
    min_factor: float = 0.25
    max_factor: float = 2.0
    min_step: float = 1e-4
    max_members: int = 20
    max_rounds: int = 6
    traction_tolerance: float = 1e-2
    stick_tolerance: float = 1e-9
    initial_step: float = 1e-2
    max_points: int = 40
    peak_tolerance: float = 1e-6
    peak_threshold: float = 0.9
    max_peaks: int = 4


TRACTION = TractionOptions()


class FixedTractionContact(Law):
    """Law of a contact that always sticks, with a prescribed mean friction force (direction,)."""

    def __init__(self, contact: Contact, law: KernelLaw) -> None:
        super().__init__(law.width, law.directions, law.margins, contact)
        self.kernel, self.mean = law.kernel, np.zeros(law.directions - 1)
        springs = np.append(np.full(law.directions - 1, law.k_u), law.k_v)
        waves = np.tile(np.repeat(springs, 2), (law.width - law.directions) // (2 * law.directions))
        self.springs = np.concatenate((0.0 * springs[:-1], springs[-1:], waves))
        self.force, self.tangent = np.zeros(law.width), np.diag(self.springs)
        self.without_margins()

    def evaluate(self, x: FloatArray, first: int) -> int:
        """Compute the forces; the tangent is always that of the springs."""
        self.force[:] = self.springs * np.asarray(x)[first : first + self.width]
        self.force[: self.mean.size] = self.mean
        self.force[self.mean.size] += min(self.n_0, 0.0)
        return 0

    def mean_from(self, block: FloatArray, start: FloatArray) -> FloatArray | None:
        """Mean friction force of a contact whose slider began at start; None where it slips or opens."""
        self.kernel.at(block, ContactParameters(self.mu, self.k_u, self.k_v, self.n_0, *start.tolist()))
        force, spring = np.array(self.kernel.forces), (self.springs * block)[self.directions :]
        off = np.abs(force[self.directions :] - spring).max()
        return force[: start.size] if off <= TRACTION.stick_tolerance * np.abs(spring).max() else None


class _FixedTractionBalance:
    """A balance with prescribed mean friction in some contacts, and the search for its peaks."""

    def __init__(self, system: System, options: TractionOptions) -> None:
        self.system, self.options = system, options
        self.balance: Balance = system.new_balance()
        self.free = system.exact_laws(system.harmonics)
        each = zip(system.scene.contacts, self.free, strict=True)
        self.laws = [FixedTractionContact(contact, law) for contact, law in each]
        self.held: list[int] = []
        self.fix(np.zeros(0, dtype=np.intp), np.zeros((0, 0)))
        self.newton = Newton(self.balance)
        self.scale = np.ones(self.balance.unknowns + 1)

    def fix(self, contacts: npt.NDArray[np.intp], mean: FloatArray) -> None:
        """Prescribe the mean friction forces (contact, direction) of some contacts, and of no others."""
        laws: list[Law] = list(self.free)
        self.held = contacts.tolist()
        for i, one in zip(contacts.tolist(), mean, strict=True):
            self.laws[i].mean, laws[i] = np.array(one), self.laws[i]
        self.balance.laws = laws

    def solved(self, guess: FloatArray, row: FloatArray) -> FloatArray | None:
        """The solution near guess in the plane normal to row, in scaled coordinates; None if there is none.

        newton.tangent is then the tangent of the curve there.
        """
        self.system.work.poll()
        newton = self.newton
        newton.scale[:], newton.z[:], newton.row[:] = self.scale, guess, row
        if not newton.correct(1.0):
            return None
        point = np.array(newton.z)
        return point if newton.take_tangent() else None

    def amplitudes(self, z: FloatArray, direction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Amplitudes (dof,) at a point, and their growth along a direction in scaled coordinates."""
        self.balance.evaluate(z)
        self.balance.evaluate_outputs(z, np.ascontiguousarray(direction * self.scale))
        return np.array(self.balance.output), np.array(self.balance.growth)

    def begin(self, z: FloatArray, edge: bool) -> FloatArray | None:
        """The direction of the curve at a point; the frequency axis if edge, at an end of the range."""
        self.balance.evaluate_scale(z)
        self.scale = np.array(self.balance.scale)
        row = np.eye(z.size)[-1]
        return row if self.solved(z, row) is None or edge else np.array(self.newton.tangent)

    def sticks(self, z: FloatArray) -> bool:
        """Whether the contacts with prescribed friction would stick through the whole cycle."""
        blocks, origin = self.system.layout.blocks(z[None])[0], np.zeros(self.system.layout.directions - 1)
        each = ((self.laws[i], np.ascontiguousarray(blocks[i])) for i in self.held)
        return all(law.mean_from(block, origin) is not None for law, block in each)

    def peak(self, z: FloatArray, row: FloatArray, dof: int) -> FloatArray | None:
        """The peak of a degree of freedom next to a point: uphill on the curve within the frequency range.

        A member ends where the contacts with prescribed friction begin to slip; its last point may be the
        peak. From a point that slips, the search goes downhill. After a change of state the plane normal to
        row may have no solution; then the first point is computed at the same frequency.
        """
        low, high = self.system.scene.frequency_range
        options, here = self.options, self.solved(z, row)
        if here is None:
            here = self.solved(z, np.eye(z.size)[-1])
        if here is None:
            return None
        ahead, length, sticks = np.array(self.newton.tangent), options.initial_step, self.sticks(here)
        up = self.amplitudes(here, ahead)[1][dof]
        if (up < 0.0) == sticks:
            ahead, up = -ahead, -up
        for _ in range(options.max_points):
            point = self.solved(here + length * self.scale * ahead, ahead)
            if point is None:
                length *= options.min_factor
                continue
            tangent = np.array(self.newton.tangent)
            growth = self.amplitudes(point, tangent)[1][dof]
            outside = not low <= point[-1] <= high
            if growth > 0.0 and outside and sticks:
                point[-1] = min(max(point[-1], low), high)
                return self.solved(point, np.eye(point.size)[-1])
            if self.sticks(point) != sticks:
                ends = (0.0, length) if sticks else (length, 0.0)
                return self._last_sticking(here, ahead, *ends, dof)
            if outside and not sticks:
                return None
            if growth <= 0.0 and sticks:
                return self._between(here, ahead, (0.0, up, here), (length, growth, point), dof)
            here, ahead, up, length = point, tangent, growth, length * options.max_factor
        return None

    def _last_sticking(
        self, here: FloatArray, ahead: FloatArray, sticks: float, slips: float, dof: int
    ) -> FloatArray | None:
        """The last point that sticks, by bisection between the lengths sticks and slips along a direction."""
        for _ in range(self.options.max_points):
            at = 0.5 * (sticks + slips)
            point = self.solved(here + at * self.scale * ahead, ahead)
            sticks, slips = (at, slips) if point is not None and self.sticks(point) else (sticks, at)
            if point is None:
                continue
            height, growth = self.amplitudes(point, np.array(self.newton.tangent))
            if abs(growth[dof] * (slips - sticks)) < self.options.peak_tolerance * height[dof]:
                break
        return self.solved(here + sticks * self.scale * ahead, ahead)

    def _between(self, here: FloatArray, ahead: FloatArray, low: _End, high: _End, dof: int) -> FloatArray:
        """The peak between two points along a direction: the root of the slope by the Illinois method."""
        last = 0
        for _ in range(self.options.max_points):
            (a, up, _), (b, down, _) = low, high
            at = a + (b - a) * up / (up - down)
            point = self.solved(here + at * self.scale * ahead, ahead)
            if point is None:
                break
            height, growth = self.amplitudes(point, np.array(self.newton.tangent))
            side = 1 if growth[dof] > 0.0 else -1
            if side > 0:
                low, high = (at, growth[dof], point), (b, 0.5 * down if last == side else down, high[2])
            else:
                low, high = (a, 0.5 * up if last == side else up, low[2]), (at, growth[dof], point)
            last = side
            if abs(growth[dof]) * (high[0] - low[0]) < self.options.peak_tolerance * height[dof]:
                break
        peak = max((low[2], high[2]), key=lambda one: self.amplitudes(one, ahead)[0][dof])
        self.solved(peak, ahead)  # sets newton.tangent
        return peak

    def derivatives(
        self, z: FloatArray, row: FloatArray, ports: npt.NDArray[np.intp]
    ) -> tuple[FloatArray, FloatArray]:
        """Derivatives of amplitudes and of mean normal displacements by the mean friction at some ports.

        They are (port, dof) and (port, contact), in the plane normal to row.
        """
        balance, scale, layout = self.balance, self.scale, self.system.layout
        normal = np.asarray(balance.layout.mean_at)[layout.directions - 1 :: layout.directions]
        balance.evaluate(z)
        force = np.zeros((balance.unknowns, ports.size))
        force[np.asarray(balance.layout.mean_at)[ports], np.arange(ports.size)] = 1.0
        right = np.concatenate(
            (-apply_compliance(balance, force) / scale[:-1, None], np.zeros((1, ports.size)))
        )
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
            balance.evaluate_outputs(z, np.ascontiguousarray(direction * scale))
            found[k] = balance.growth
        return found, (right * scale[:, None])[normal].T


class _Family:
    """The members of the family of one peak that have their tractions at the limits."""

    def __init__(
        self, members: _FixedTractionBalance, z: FloatArray, stuck: BoolArray, dof: int, edge: bool
    ) -> None:
        self.members, self.options, self.dof, self.edge = members, members.options, dof, edge
        self.contacts, directions = np.flatnonzero(stuck), members.system.layout.directions
        self.along = directions - 1
        self.ports = (directions * self.contacts[:, None] + np.arange(self.along)).ravel()
        contacts = [members.system.scene.contacts[i] for i in self.contacts]
        self.fixed = np.zeros((len(contacts), self.along), dtype=np.bool_)  # no motion: contacts on a line
        self.fixed[:, 1:] = np.array([c.second is None for c in contacts])[:, None]
        members.fix(self.contacts[:0], np.zeros((0, self.along)))
        self.z, self.row = z, members.begin(z, edge)

    def change(self) -> FloatArray:
        """Greatest relative changes of the amplitudes (dof,); NaN where no member was found.

        In a corner of the curve, as where a contact begins to slip, the peak is the point itself. Only the
        member with the traction of that point has a tangent there.
        """
        members = self.members
        nothing = np.full(members.balance.outputs, np.nan)
        found = None if self.row is None else self._top(self.z, self.row)
        row = None if found is None or self.row is None else self._row(self.row)
        base = self.z if found is None else found
        before = members.amplitudes(base, np.zeros(base.size))[0]
        own = self._limits(base, np.zeros((self.contacts.size, self.along)))
        if own is None:
            return nothing
        if row is None:
            members.fix(self.contacts, own)
            row = members.begin(base, self.edge)
        if row is None:
            return nothing
        most = np.zeros(before.size)
        for sense in (1.0, -1.0):
            visited = self._visited(base, row, own, sense)
            if visited is None:
                return nothing
            for after in visited:
                most = np.maximum(most, np.abs(after - before) / np.where(before > 0.0, before, 1.0))
        return most

    def _row(self, row: FloatArray) -> FloatArray:
        return row if self.edge else np.array(self.members.newton.tangent)

    def _top(self, z: FloatArray, row: FloatArray) -> FloatArray | None:
        return self.members.solved(z, row) if self.edge else self.members.peak(z, row, self.dof)

    def _visited(
        self, z: FloatArray, row: FloatArray, mean: FloatArray, sense: float
    ) -> list[FloatArray] | None:
        """Amplitudes (dof,) of the members visited towards the greatest (sense 1) or least (-1) peak.

        None if no member was found. Every member at its limits counts, since a derivative may point the wrong
        way after a change of state.
        """
        members, visited = self.members, list[FloatArray]()
        members.fix(self.contacts, mean)
        best = members.amplitudes(z, row)[0]
        for _ in range(self.options.max_rounds):
            amplitudes, normal = members.derivatives(z, row, self.ports)
            by = amplitudes[:, self.dof].reshape(-1, self.along)
            by[self.fixed] = 0.0
            size = np.linalg.norm(by, axis=1, keepdims=True)
            room = size[:, 0] @ np.array([self._friction_bound(i, z) for i in self.contacts.tolist()])
            if room <= self.options.min_change * best[self.dof]:
                towards = None if visited else self._by_nearest_load(z, normal)
                if towards is None:
                    return visited
                by, size = towards, np.linalg.norm(towards, axis=1, keepdims=True)
            limits = self._limits(z, -sense * by / np.where(size > 0.0, size, 1.0))
            if limits is None:  # a contact slips there
                return visited
            limits = np.where(size > 0.0, limits, mean)
            if np.abs(limits - mean).max() <= self.options.traction_tolerance * np.abs(limits).max():
                return visited
            found = self._moved(z, row, mean, limits)
            if found is None:
                return visited or None
            z, mean, row = found, limits, self._row(row)
            height = members.amplitudes(z, row)[0]
            visited.append(height)
            if sense * (height[self.dof] - best[self.dof]) <= 0.0:
                return visited
            best = height
        return visited

    def _by_nearest_load(self, z: FloatArray, normal: FloatArray) -> FloatArray | None:
        """Derivative (contact, direction), by the friction forces, of the load of one contact.

        It is the contact that these forces bring nearest to a change of state, or beyond; None if they bring
        no contact to it. normal (port, contact) are the derivatives of the mean normal displacements.
        """
        members, layout = self.members, self.members.system.layout
        laws, blocks = members.free, layout.blocks(z[None])[0]
        mu, k_u, k_v, n_0 = np.array([(law.mu, law.k_u, law.k_v, law.n_0) for law in laws]).T
        size = np.linalg.norm(
            blocks[:, layout.directions :].reshape(len(laws), -1, layout.directions, 2), axis=3
        )
        load = n_0 + k_v * blocks[:, layout.directions - 1]
        friction = k_u * size[:, :, :-1].sum(axis=(1, 2))
        to_slip = np.divide(friction, mu, out=np.zeros_like(mu), where=(mu > 0.0) & (load > 0.0))
        margin = np.maximum(np.abs(load) - k_v * size[:, :, -1].sum(axis=1) - to_slip, 0.0)
        by = (k_v * normal.reshape(-1, self.along, len(laws))).transpose(2, 0, 1)
        by[:, self.fixed] = 0.0
        limits = (mu * np.maximum(load, 0.0))[self.contacts]
        change = np.linalg.norm(by, axis=2) @ limits
        near = int(np.argmax(np.where(change > 0.0, change / np.maximum(margin, 1e-300), 0.0)))
        found: FloatArray = by[near]
        return found if change[near] > margin[near] else None

    def _limits(self, z: FloatArray, towards: FloatArray) -> FloatArray | None:
        """Mean friction forces (contact, direction) of sliders that began far beyond their limits.

        towards (contact, direction) gives the side; sliders with 0 there began unstressed. None if a contact
        slips or opens.
        """
        members, layout = self.members, self.members.system.layout
        blocks = layout.blocks(z[None])[0]
        found = np.zeros_like(towards)
        for k, i in enumerate(self.contacts.tolist()):
            block = np.ascontiguousarray(blocks[i])
            far = self.options.start_distance * self._friction_bound(i, z) / members.laws[i].k_u
            start = block[: self.along] + far * towards[k] if towards[k].any() else np.zeros(self.along)
            one = members.laws[i].mean_from(block, start)
            if one is None:
                return None
            found[k] = one
        return found

    def _friction_bound(self, i: int, z: FloatArray) -> float:
        """An upper bound of the friction force of a contact."""
        law, layout = self.members.laws[i], self.members.system.layout
        x = np.abs(layout.blocks(z[None])[0, i])
        normal = x[layout.directions - 1] + x[layout.directions :].sum()
        return float(law.mu * (abs(law.n_0) + law.k_v * normal) + law.k_u * x.sum())

    def _moved(self, z: FloatArray, row: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray | None:
        """Continue the peak from the friction forces begin to end; None if it takes too many steps."""
        members, done, share = self.members, 0.0, 1.0
        for _ in range(self.options.max_members):
            at = min(done + share, 1.0)
            members.fix(self.contacts, begin + at * (end - begin))
            found = self._top(z, row)
            if found is None:
                share *= self.options.min_factor
                if share < self.options.min_step:
                    return None
                continue
            z, done, share, row = found, at, share * self.options.max_factor, self._row(row)
            if done == 1.0:
                return z
        return None


def peak_changes(
    system: System,
    z: FloatArray,
    amplitude: FloatArray,
    top: npt.NDArray[np.intp],
    stuck: BoolArray,
    options: TractionOptions = TRACTION,
) -> FloatArray:
    """Estimate the relative changes of peaks (dof,) by residual tractions, as the module describes.

    Parameters
    ----------
    system : System
    z : (point, unknown + 1)
        Points of a curve; a peak at an end of the scene's range keeps its frequency.
    amplitude : (point, dof)
    top : (dof,)
        The points at which the peaks are.
    stuck : (dof, contact)
        Whether a contact sticks through the whole cycle there, and its traction may affect another contact.
    options : TractionOptions, optional

    Returns
    -------
    (dof,)
        0 where no such contact sticks; NaN where no member was found, or there are too many peaks.

    Examples
    --------
    Here no other contact feels the traction of one that sticks, so that it changes no peak:

    >>> import fcm, numpy as np
    >>> system = System(fcm.load_scene("yang1998-n5"))
    >>> z, none = np.zeros((1, system.layout.unknowns + 1)), np.zeros((2, 1), dtype=bool)
    >>> peak_changes(system, z, np.ones((1, 2)), np.zeros(2, dtype=int), none).tolist()
    [0.0, 0.0]
    """
    own = amplitude[top, np.arange(top.size)]
    edge = np.isin(z[top, -1], system.scene.frequency_range)
    found = np.where(stuck.any(axis=1) & (own > 0.0), np.nan, 0.0)
    members, left = None, options.max_peaks
    for d in np.argsort(-own, kind="stable").tolist():
        if not np.isnan(found[d]) or not left:
            continue
        members = members or _FixedTractionBalance(system, options)
        change = _Family(members, z[top[d]], stuck[d], d, bool(edge[d])).change()
        near = np.isnan(found) & (amplitude[top[d]] >= options.peak_threshold * own) & (edge == edge[d])
        found[near], left = change[near], left - 1
        if np.isnan(change[d]):
            break
    return found

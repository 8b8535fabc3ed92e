"""Contacts that stick, or are open, all over a range: springs, or nothing, in their places.

Which these are is foreseen by the converged balance. Whether they did is seen afterwards from the
exact motion itself, at every point that was found: a contact that would have slipped, opened or closed in one
of them is computed after all.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.continuation import Status
from fcm.harmonic_balance.static_equilibrium import RestError
from fcm.model.scene import Contact, HeldContact, Scene, has_friction
from fcm.reduction.options import REDUCTION
from fcm.reduction.sentences import named
from fcm.results.result import Curve
from fcm.shooting.harmonic_balance_branches import every_balance
from fcm.shooting.periodic_orbit import never_interrupt
from fcm.shooting.residual import Shot
from fcm.shooting.residual_traction import resting
from fcm.time_domain.state import State

IntArray = npt.NDArray[np.intp]
WORDS = (  # on a contact that sticks, and on one that is open
    ("sticks", "stick", "springs instead", "slip limit"),
    ("is open", "are open", "nothing instead", "gap"),
)


def expected_constant(scene: Scene, poll: Callable[[], None] | None = None) -> tuple[HeldContact, ...]:
    """The contacts that keep their state all along every branch of the converged balance.

    poll is called now and then.
    """
    z, harmonics = _balanced(scene, poll)
    if not z.size:
        return ()
    theta = 2.0 * np.pi * np.arange(REDUCTION.cycle_angles) / REDUCTION.cycle_angles
    x = z[:, :-1].reshape(z.shape[0], len(scene.contacts), -1)
    mean = x[:, :, :2] + scene.sliders().reshape(-1, 2)
    motion = np.repeat(mean[..., None], REDUCTION.cycle_angles, axis=-1)
    for i, h in enumerate(harmonics):
        wave = x[:, :, 2 + 4 * i : 6 + 4 * i, None]
        motion += wave[:, :, ::2] * np.cos(h * theta) - wave[:, :, 1::2] * np.sin(h * theta)
    found, rest = [], resting(scene)
    for i, contact in enumerate(scene.contacts):
        u, v = motion[:, i].swapaxes(0, 1)
        one = _keeps(i, contact, float(rest[i]), u, v)
        if one is not None and not _too_stiff(scene, contact):
            found.append(one)
    return tuple(found)


def _balanced(scene: Scene, poll: Callable[[], None] | None) -> tuple[FloatArray, tuple[int, ...]]:
    """Points z of that balance (point, unknown + 1), and its harmonics; none where it is not complete."""
    try:
        found = every_balance(scene, poll or never_interrupt)
    except RestError:
        return np.zeros((0, 0)), ()
    branches = found.traced.branches
    if branches.status is not Status.COMPLETE or not branches.paths:
        return np.zeros((0, 0)), ()
    return np.concatenate([path.z for path in branches.paths]), found.system.harmonics


def _keeps(place: int, contact: Contact, rest: float, u: FloatArray, v: FloatArray) -> HeldContact | None:
    """The contact as it is held, if it keeps its state in motions u and v (point, angle)."""
    load = contact.n_0 + contact.k_v * v
    if load.max() < REDUCTION.load_margin * min(contact.n_0, 0.0):
        return HeldContact(place, contact, True)
    least = load.min(axis=1)
    if not (least > REDUCTION.load_margin * load.max(axis=1)).all():
        return None
    limit = contact.mu * load
    force = np.abs(contact.k_u * (u - rest)) if has_friction(contact) else np.zeros_like(u)
    return (
        HeldContact(place, contact, False, rest)
        if (force <= (1.0 - REDUCTION.load_margin) * limit).all()
        else None
    )


def _too_stiff(scene: Scene, contact: Contact) -> bool:
    modal = scene.modal
    pairs = ((contact.k_u, contact.tangential), (contact.k_v, contact.normal))
    added = max(k * float(((modal.shapes @ way) ** 2 / modal.mass).sum()) for k, way in pairs)
    return added > REDUCTION.stiffness_ratio * float(modal.frequency.max()) ** 2


class NotKeptError(Exception):
    """Contacts that are held, their `places`, would not have kept their state in a motion.

    reason : why the curve of such motions is not complete.
    """

    def __init__(self, places: tuple[int, ...], reason: str = "") -> None:
        super().__init__()
        self.places, self.reason = places, reason


def check_kept(shot: Shot) -> None:
    """`NotKeptError` if a contact that is held would not have kept its state over a motion."""
    pairs = zip(shot.system.scene.held, shot.held_distances.tolist(), strict=True)
    lost = tuple(one.place for one, room in pairs if room <= 0.0)
    if lost:
        raise NotKeptError(lost)


def lost_by(kept: FloatArray) -> IntArray:
    """The contacts that have not kept their state, of what each keeps: (contact, 2)."""
    return np.flatnonzero((kept <= 0.0).any(axis=1))


def whole_state(scene: Scene, state: State) -> State:
    """A state of a scene with contacts held as one of the whole scene."""
    friction = np.zeros(len(scene.contacts) + len(scene.held))
    friction[scene.computed()] = state.friction
    displacement = scene.modal.shapes.T @ state.q
    for one in scene.held:
        if has_friction(one.contact) and not one.open:
            stretched = float(one.contact.tangential @ displacement) - one.rest
            friction[one.place] = one.contact.k_u * stretched
    return State(state.q, state.velocity, friction, state.angle)


def whole_states(scene: Scene, states: Sequence[str]) -> tuple[str, ...]:
    """State sequence of each contact of the whole scene, the held ones included."""
    letters = dict(zip(scene.computed(), states, strict=True))
    letters |= {one.place: "S" if one.open else "E" for one in scene.held}
    return tuple(letters[i] for i in range(len(letters)))


def whole_contact_loads(scene: Scene, computed: FloatArray, held: FloatArray) -> FloatArray:
    """Contact loads of every contact of the whole scene, as of `contact_loads`; held ones do not slip.

    held : of these the normal and the friction force, (held, 2).
    """
    every = np.zeros((len(scene.contacts) + len(scene.held), 4))
    every[scene.computed()] = computed
    for one, forces in zip(scene.held, held, strict=True):
        if not one.open:
            every[one.place, :2] = forces
    return every


def on_contacts(curves: Sequence[Curve], contacts: Sequence[Contact]) -> list[str]:
    """Sentences on contacts left out of curves since they keep their state, with their margins."""
    each = [curve.orbits.held for curve in curves if curve.orbits is not None and curve.orbits.held.size]
    if not each:
        return []
    said, kept = [], np.array(each)  # (curve, contact, state)
    for state, (one, many, instead, limit) in enumerate(WORDS):
        known = np.isfinite(kept[:, :, state])
        places = np.flatnonzero(known.any(axis=0)).tolist()
        if places:
            count = int(known.any(axis=1).sum())
            where = (
                ""
                if known[:, places].all() and count == len(curves)
                else f" of {count} of {len(curves)} curves"
            )
            least = float(np.nanmin(kept[:, places, state]))
            does = one if len(places) == 1 else many
            said.append(
                f"the transitions of {named(contacts, places)}, which {does} all over the range{where}: "
                f"{instead}. At every point found at least {100.0 * least:.0f} % of the {limit} is left "
                "(no effect)"
            )
    return said

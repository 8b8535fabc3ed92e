"""Replaces contacts that stick or are open over the whole range by springs or nothing.

The converged harmonic balance predicts which contacts keep their state. The exact motion is then checked at
every point found: a contact that would have slipped, opened or closed there is computed after all.
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
WORDS = (  # phrases for sticking contacts, and for open ones
    ("sticks", "stick", "springs instead", "slip limit"),
    ("is open", "are open", "nothing instead", "gap"),
)


def expected_constant(scene: Scene, poll: Callable[[], None] | None = None) -> tuple[HeldContact, ...]:
    """The contacts that keep their state along every branch of the converged harmonic balance.

    poll is called from time to time.
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
    """Points z (point, unknown + 1) of the converged balance, and its harmonics; none if it is incomplete."""
    try:
        found = every_balance(scene, poll or never_interrupt)
    except RestError:
        return np.zeros((0, 0)), ()
    branches = found.traced.branches
    if branches.status is not Status.COMPLETE or not branches.paths:
        return np.zeros((0, 0)), ()
    return np.concatenate([path.z for path in branches.paths]), found.system.harmonics


def _keeps(place: int, contact: Contact, rest: float, u: FloatArray, v: FloatArray) -> HeldContact | None:
    """The contact as a held one if it keeps its state in the motions u and v (point, angle); else None."""
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
    """Raised if held contacts, at `places`, would not have kept their state in a motion.

    reason : why the curve of these motions is incomplete.
    """

    def __init__(self, places: tuple[int, ...], reason: str = "") -> None:
        super().__init__()
        self.places, self.reason = places, reason


def check_kept(shot: Shot) -> None:
    """Raises `NotKeptError` if a held contact would not have kept its state over a motion."""
    pairs = zip(shot.system.scene.held, shot.held_distances.tolist(), strict=True)
    lost = tuple(one.place for one, room in pairs if room <= 0.0)
    if lost:
        raise NotKeptError(lost)


def lost_by(kept: FloatArray) -> IntArray:
    """Indices of the contacts that did not keep their state, from their margins kept (contact, 2)."""
    return np.flatnonzero((kept <= 0.0).any(axis=1))


def whole_state(scene: Scene, state: State) -> State:
    """The state of the whole scene, from that of a scene with held contacts."""
    friction = np.zeros(len(scene.contacts) + len(scene.held))
    friction[scene.computed()] = state.friction
    displacement = scene.modal.shapes.T @ state.q
    for one in scene.held:
        if has_friction(one.contact) and not one.open:
            stretched = float(one.contact.tangential @ displacement) - one.rest
            friction[one.place] = one.contact.k_u * stretched
    return State(state.q, state.velocity, friction, state.angle)


def whole_states(scene: Scene, states: Sequence[str]) -> tuple[str, ...]:
    """State sequence of each contact of the whole scene, including held ones."""
    letters = dict(zip(scene.computed(), states, strict=True))
    letters |= {one.place: "S" if one.open else "E" for one in scene.held}
    return tuple(letters[i] for i in range(len(letters)))


def whole_contact_loads(scene: Scene, computed: FloatArray, held: FloatArray) -> FloatArray:
    """Contact loads of all contacts of the whole scene, as from `contact_loads`.

    held : normal and friction force (held, 2) of held contacts, which do not slip.
    """
    every = np.zeros((len(scene.contacts) + len(scene.held), 4))
    every[scene.computed()] = computed
    for one, forces in zip(scene.held, held, strict=True):
        if not one.open:
            every[one.place, :2] = forces
    return every


def on_contacts(curves: Sequence[Curve], contacts: Sequence[Contact]) -> list[str]:
    """Sentences on contacts that were held in curves because they keep their state, with their margins."""
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

"""What the structure answers to forces of its contacts: G F, of forces laid out as the unknowns of a balance.

Laid out as in `fcm.structure.layout`. Each harmonic is answered by its own receptance, the mean by the static
one.
"""

from __future__ import annotations

import cython

from fcm.structure.receptance import Receptance


@cython.cfunc
@cython.exceptval(check=False)
def times_forces(seen: Receptance, force: cython.double[::1], out: cython.double[::1]) -> cython.void:
    """Fill out (unknown,) with the answer to forces (unknown,)."""
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(seen.ports):
        total: cython.double = 0.0
        for q in range(seen.ports):
            total += seen.static[p, q] * force[seen.mean_at[q]]
        out[seen.mean_at[p]] = total
        for j in range(seen.count):
            re: cython.double = 0.0
            im: cython.double = 0.0
            for q in range(seen.ports):
                f = seen.wave_at[q] + seen.stride * j
                re += seen.G_re[j, p, q] * force[f] - seen.G_im[j, p, q] * force[f + 1]
                im += seen.G_im[j, p, q] * force[f] + seen.G_re[j, p, q] * force[f + 1]
            row = seen.wave_at[p] + seen.stride * j
            out[row], out[row + 1] = re, im


@cython.cfunc
@cython.exceptval(check=False)
def times_tangents(
    seen: Receptance, tangent: cython.double[:, :, ::1], out: cython.double[:, ::1]
) -> cython.void:
    """Fill out (unknown, unknown) with the answers to the changes of forces by tangents (contact, w, w)."""
    contacts: cython.Py_ssize_t = tangent.shape[0]
    w: cython.Py_ssize_t = tangent.shape[1]
    each: cython.Py_ssize_t = seen.ports // contacts if contacts > 0 else 0
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    c: cython.Py_ssize_t
    d: cython.Py_ssize_t
    k: cython.Py_ssize_t
    j: cython.Py_ssize_t
    re: cython.double
    im: cython.double
    for p in range(seen.ports):
        for c in range(contacts):
            row = seen.mean_at[p]
            for d in range(each):
                re = seen.static[p, c * each + d]
                for k in range(w):
                    if d == 0:
                        out[row, c * w + k] = re * tangent[c, d, k]
                    else:
                        out[row, c * w + k] += re * tangent[c, d, k]
            for j in range(seen.count):
                row = seen.wave_at[p] + seen.stride * j
                for d in range(each):
                    re, im = seen.G_re[j, p, c * each + d], seen.G_im[j, p, c * each + d]
                    f = each + seen.stride * j + 2 * d
                    if d == 0:
                        for k in range(w):
                            out[row, c * w + k] = re * tangent[c, f, k] - im * tangent[c, f + 1, k]
                            out[row + 1, c * w + k] = im * tangent[c, f, k] + re * tangent[c, f + 1, k]
                    else:
                        for k in range(w):
                            out[row, c * w + k] += re * tangent[c, f, k] - im * tangent[c, f + 1, k]
                            out[row + 1, c * w + k] += im * tangent[c, f, k] + re * tangent[c, f + 1, k]


@cython.cfunc
@cython.exceptval(check=False)
def slope(
    seen: Receptance, force: cython.double[::1], load: cython.double, out: cython.double[::1]
) -> cython.void:
    """Fill out (unknown,) with the derivative by the frequency of the answer to forces, less that to a level
    of the external ones; the means have none."""
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(seen.ports):
        out[seen.mean_at[p]] = 0.0
        for j in range(seen.count):
            row = seen.wave_at[p] + seen.stride * j
            re: cython.double = 0.0
            im: cython.double = 0.0
            for q in range(seen.ports):
                f = seen.wave_at[q] + seen.stride * j
                re += seen.dG_re[j, p, q] * force[f] - seen.dG_im[j, p, q] * force[f + 1]
                im += seen.dG_im[j, p, q] * force[f] + seen.dG_re[j, p, q] * force[f + 1]
            out[row], out[row + 1] = re, im
    less_external_slopes(seen, load, out)


@cython.cfunc
@cython.exceptval(check=False)
def less_external(seen: Receptance, load: cython.double, out: cython.double[::1]) -> cython.void:
    """Take from out (unknown,) the answer to a level of the external forces."""
    j: cython.int
    p: cython.Py_ssize_t
    for j in range(seen.count):
        k: cython.int = seen.forced[j]
        if k >= 0:
            for p in range(seen.ports):
                row: cython.Py_ssize_t = seen.wave_at[p] + seen.stride * j
                out[row] -= load * seen.X_re[k, p]
                out[row + 1] -= load * seen.X_im[k, p]


@cython.cfunc
@cython.exceptval(check=False)
def less_external_slopes(seen: Receptance, load: cython.double, out: cython.double[::1]) -> cython.void:
    """Take from out (unknown,) the derivative of that by the frequency."""
    j: cython.int
    p: cython.Py_ssize_t
    for j in range(seen.count):
        k: cython.int = seen.forced[j]
        if k >= 0:
            for p in range(seen.ports):
                row: cython.Py_ssize_t = seen.wave_at[p] + seen.stride * j
                out[row] -= load * seen.dX_re[k, p]
                out[row + 1] -= load * seen.dX_im[k, p]

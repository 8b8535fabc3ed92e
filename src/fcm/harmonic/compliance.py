"""What the structure answers to forces of its contacts: G F, of forces laid out as the unknowns of a balance.

Contact after contact the mean and the real and imaginary part of each harmonic, see `law`. Each harmonic is
answered by its own receptance, the mean by the static one.
"""

from __future__ import annotations

import cython

from fcm.structure.receptance import Receptance


@cython.cfunc
@cython.exceptval(check=False)
def times_forces(seen: Receptance, force: cython.double[::1], out: cython.double[::1]) -> cython.void:
    """Fill out (unknown,) with the answer to forces (unknown,)."""
    w: cython.Py_ssize_t = 2 + 4 * seen.count
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(seen.ports):
        row = (p // 2) * w + p % 2
        out[row] = 0.0
        for q in range(seen.ports // 2):
            out[row] += seen.static[p, 2 * q] * force[q * w] + seen.static[p, 2 * q + 1] * force[q * w + 1]
        for j in range(seen.count):
            row = (p // 2) * w + 2 + 4 * j + 2 * (p % 2)
            out[row] = out[row + 1] = 0.0
            for q in range(seen.ports // 2):
                u_re: cython.double = seen.G_re[j, p, 2 * q]
                u_im: cython.double = seen.G_im[j, p, 2 * q]
                v_re: cython.double = seen.G_re[j, p, 2 * q + 1]
                v_im: cython.double = seen.G_im[j, p, 2 * q + 1]
                f = q * w + 2 + 4 * j
                out[row] += u_re * force[f] - u_im * force[f + 1]
                out[row] += v_re * force[f + 2] - v_im * force[f + 3]
                out[row + 1] += u_im * force[f] + u_re * force[f + 1]
                out[row + 1] += v_im * force[f + 2] + v_re * force[f + 3]


@cython.cfunc
@cython.exceptval(check=False)
def times_tangents(
    seen: Receptance, tangent: cython.double[:, :, ::1], out: cython.double[:, ::1]
) -> cython.void:
    """Fill out (unknown, unknown) with the answers to the changes of forces by tangents (contact, w, w)."""
    w: cython.Py_ssize_t = 2 + 4 * seen.count
    row: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    k: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(seen.ports):
        for q in range(seen.ports // 2):
            row = (p // 2) * w + p % 2
            S_u: cython.double = seen.static[p, 2 * q]
            S_v: cython.double = seen.static[p, 2 * q + 1]
            for k in range(w):
                out[row, q * w + k] = S_u * tangent[q, 0, k] + S_v * tangent[q, 1, k]
            for j in range(seen.count):
                row = (p // 2) * w + 2 + 4 * j + 2 * (p % 2)
                u_re: cython.double = seen.G_re[j, p, 2 * q]
                u_im: cython.double = seen.G_im[j, p, 2 * q]
                v_re: cython.double = seen.G_re[j, p, 2 * q + 1]
                v_im: cython.double = seen.G_im[j, p, 2 * q + 1]
                for k in range(w):
                    a: cython.double = tangent[q, 2 + 4 * j, k]
                    b: cython.double = tangent[q, 3 + 4 * j, k]
                    c: cython.double = tangent[q, 4 + 4 * j, k]
                    d: cython.double = tangent[q, 5 + 4 * j, k]
                    out[row, q * w + k] = u_re * a - u_im * b + v_re * c - v_im * d
                    out[row + 1, q * w + k] = u_im * a + u_re * b + v_im * c + v_re * d


@cython.cfunc
@cython.exceptval(check=False)
def slope(
    seen: Receptance, force: cython.double[::1], load: cython.double, out: cython.double[::1]
) -> cython.void:
    """Fill out (unknown,) with the derivative by the frequency of the answer to forces, less that to a level
    of the external ones; the means have none."""
    w: cython.Py_ssize_t = 2 + 4 * seen.count
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(seen.ports):
        out[(p // 2) * w + p % 2] = 0.0
        for j in range(seen.count):
            row = (p // 2) * w + 2 + 4 * j + 2 * (p % 2)
            re: cython.double = 0.0
            im: cython.double = 0.0
            for q in range(seen.ports):
                f = (q // 2) * w + 2 + 4 * j + 2 * (q % 2)
                re += seen.dG_re[j, p, q] * force[f] - seen.dG_im[j, p, q] * force[f + 1]
                im += seen.dG_im[j, p, q] * force[f] + seen.dG_re[j, p, q] * force[f + 1]
            if j == seen.driven:
                re -= load * seen.dX_re[p]
                im -= load * seen.dX_im[p]
            out[row], out[row + 1] = re, im

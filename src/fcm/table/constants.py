"""Constants of the atlas: the strength of grading of its coordinates; see `atlas`.

They were found by trial. With the nodes of the fast table they give a greatest error of 8.5e-4 at 100 000
points. FOLD_Z 1.5 gives 1.1e-3, FOLD_Z 1.565 9.3e-4, FOLD_U 1.35 9.2e-4, and CONE 0.2 1.3e-3. FOLD_U 1.0,
CONE 0.05, or a TIP 100 times as great or small do not change it.
"""

FOLD_Z = 1.555  # z is graded towards phi = 0, pi: 2 phi / pi - 1 = sin(FOLD_Z (2 z - 1)) / sin(FOLD_Z)
FOLD_U = 1.2  # u is graded in the same way towards theta_1 = 0
CONE = 0.1  # (width of the cone at b = 1)^2 is CONE (sin(phi)^2 + TIP)
TIP = 1e-8  # keeps this width above 0 at phi = 0, pi
LARGEST_B = 1e8  # beyond, G has reached its limit
HUGE_B = 1e150  # beyond, ell_1 and ell_2 would overflow

"""Constants of the atlas: how strongly its coordinates gather, and where; see `atlas`."""

FOLD_Z = 1.555  # z gathers near phi = 0, pi: 2 phi / pi - 1 = sin(FOLD_Z (2 z - 1)) / sin(FOLD_Z)
FOLD_U = 1.2  # the same towards theta_1 = 0
CONE = 0.1  # (width of the cone at b = 1)^2 is CONE (sin(phi)^2 + TIP)
TIP = 1e-8
LARGEST_B = 1e8  # beyond, G has reached its limit
HUGE_B = 1e150  # beyond, ell_1 and ell_2 would overflow

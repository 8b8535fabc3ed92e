"""Constants of the atlas: how strongly its coordinates gather, and where; see `atlas`.

Found by trial. With the nodes of the fast table and these the greatest error at 100 000 points is 8.5e-4;
with FOLD_Z 1.5 1.1e-3 and with 1.565 9.3e-4, with FOLD_U 1.35 9.2e-4, with CONE 0.2 1.3e-3. FOLD_U 1.0, CONE
0.05 and a TIP 100 times as great or as small leave it as it is.
"""

FOLD_Z = 1.555  # z gathers near phi = 0, pi: 2 phi / pi - 1 = sin(FOLD_Z (2 z - 1)) / sin(FOLD_Z)
FOLD_U = 1.2  # the same towards theta_1 = 0
CONE = 0.1  # (width of the cone at b = 1)^2 is CONE (sin(phi)^2 + TIP)
TIP = 1e-8  # keeps that width above 0 at phi = 0, pi
LARGEST_B = 1e8  # beyond, G has reached its limit
HUGE_B = 1e150  # beyond, ell_1 and ell_2 would overflow

"""The oscillator of the paper as the text of a scene, for tests that need any scene with a contact."""


def oscillator(rest: str, damping: float = 0.01, n_0: float = 5.0, amplitude: float = 1.0) -> str:
    """Two modes, a contact named shroud and a force; `rest` is what follows, [response] at least."""
    return f"""
[modal]
dofs = ["u", "v"]
frequency = [1.0, 10.0]
damping = {damping}
shapes = [[0.707, 0.707], [1.0, -0.5]]
[[contact]]
name = "shroud"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = {n_0}
[[force]]
dof = "u"
amplitude = {amplitude}
{rest}"""

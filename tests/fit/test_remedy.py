"""Data in other units, or of another phase, are told by what one change of them would do to the misfit."""

import numpy as np
import pytest

from fcm.response.fit import fit
from fcm.scene.load import scene_from_dict

K_U, DAMPING = 0.7, 0.02
OMEGA = np.linspace(1.0, 1.6, 21)


def linear(k_u=K_U, damping=DAMPING):
    """Complex displacement over sin(omega t) of a mass whose contact never slips: worked out by hand."""
    return 2.0 / (1.0 + k_u - OMEGA**2 + 2j * damping * OMEGA)


@pytest.fixture
def fitted(tmp_path):
    """The fit to files of complex values, of which phases are told or not."""

    def run(*values, phased=True, start=K_U):
        data = []
        for number, value in enumerate(values):
            name = f"{number}.csv"
            rows = zip(OMEGA, np.abs(value), np.angle(value), strict=True)
            lines = [",".join(f"{x:.9g}" for x in (row if phased else row[:2])) for row in rows]
            head = "frequency,amplitude" + (",phase" if phased else "")
            (tmp_path / name).write_text("\n".join([head, *lines]))
            data.append({"file": name, "dof": "u"})
        scene = {
            "modal": {"dofs": ["u", "v"], "frequency": [1.0, 9.0], "damping": [DAMPING, 0.1],
                      "shapes": [[1.0, 0.0], [0.0, 1.0]]},
            "contact": [{"name": "c", "tangential": "u", "normal": "v", "mu": 1e6, "k_u": start, "k_v": 1.0,
                         "n_0": 1.0}],
            "force": [{"dof": "u", "amplitude": 2.0}],
            "response": {"frequency": [0.8, 1.8], "harmonics": 1},
            "fit": {"vary": ["contact.c.k_u"], "bounds": [[0.5, 0.9]], "starts": 1, "data": data},
        }  # fmt: skip
        found = fit(scene_from_dict(scene, folder=tmp_path), harmonics=1).fitted
        return [one for one in found.problems() if "would bring" in one]

    return run


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changed", "phased", "said"),
    [
        (lambda y: 1000.0 * y, False, "0.csv: a factor of 0.001 on the amplitudes would bring"),
        (lambda y: y / 9.81, True, "0.csv: a factor of 9.8 on the amplitudes would bring"),
        (np.conj, True, "0.csv: phases of the opposite sign would bring"),
        (lambda y: 1j * y, True, "0.csv: phases turned by -90 degrees would bring"),
        (lambda y: -y.conj() / 100.0, True,
         "0.csv: a factor of 1e+02 on the amplitudes and phases of the opposite sign, turned by"),
    ],
)  # fmt: skip
def test_one_change_that_mends_the_data_is_named(fitted, changed, phased, said):
    (sentence,) = fitted(changed(linear()), phased=phased)
    assert sentence.startswith(said)
    asked = "are unit and quantity right" if "factor" in said else "are phases those of sin(omega t + phase)"
    assert asked in sentence and sentence.endswith("?")
    after = float(sentence.partition(" % to ")[2].partition(" %")[0])
    assert after < 1.0


@pytest.mark.slow
def test_a_change_is_one_of_all_files_or_of_one(fitted):
    both = [1000.0 * linear(), 1000.0 * linear()]
    (sentence,) = fitted(*both, phased=False)
    assert sentence.startswith("all files: a factor of 0.001 on the amplitudes")
    (sentence,) = fitted(linear(), 1000.0 * linear(), phased=False)
    assert sentence.startswith("1.csv: a factor of 0.001 on the amplitudes")


@pytest.mark.slow
def test_nothing_is_said_where_the_shape_is_another(fitted):
    assert not fitted(linear(0.1))
    assert not fitted(linear())

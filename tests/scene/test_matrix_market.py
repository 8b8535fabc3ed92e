"""MatrixMarket files: each word is what the format says of it, or the line and what to write are said."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.io
import scipy.sparse

from fcm.scene.files import DataFileError, Files
from fcm.scene.matrix_market import read_matrix_market

REAL = "%%MatrixMarket matrix coordinate real general\n"
SYMMETRIC = "%%MatrixMarket matrix coordinate real symmetric\n"


def read(folder, text):
    path = folder / "K.mtx"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_matrix_market(path, Files()).toarray()


def faults(folder, text):
    with pytest.raises(DataFileError) as caught:
        read(folder, text)
    return caught.value.faults


@pytest.mark.parametrize(
    "text, right",
    [
        (SYMMETRIC + "2 2 3\n1 1 1.005D+02\n2 1 -.2025d+00\n2 2 2.\n", [[100.5, -0.2025], [-0.2025, 2.0]]),
        (REAL + "2 2 2\n1 1 1.50162-101\n2 2 -1.5+100\n", [[1.50162e-101, 0.0], [0.0, -1.5e100]]),
        ("\ufeff" + REAL + "% said\n\n2 2 2\n\n  1 1 1\r\n2 1\t3\n\n", [[1.0, 0.0], [3.0, 0.0]]),
        (REAL.upper().replace("REAL", "DOUBLE") + "1 1 1\n1 1 +2e-3\n", [[0.002]]),
        (
            REAL.replace("real", "integer") + "1 2 2\n1 1 -7\n1 2 12345678901234567890123\n",
            [[-7.0, 1.2345678901234568e22]],
        ),
        (REAL.replace("coordinate", "array") + "2 2\n1\n2\n3\n4\n", [[1.0, 3.0], [2.0, 4.0]]),
        (SYMMETRIC.replace("coordinate", "array") + "2 2\n1\n2\n4\n", [[1.0, 2.0], [2.0, 4.0]]),
        (SYMMETRIC.replace("symm", "skew-symm") + "2 2 1\n2 1 5\n", [[0.0, -5.0], [5.0, 0.0]]),
        (
            SYMMETRIC.replace("symm", "skew-symm").replace("coordinate", "array") + "3 3\n1\n2\n3\n",
            [[0.0, -1.0, -2.0], [1.0, 0.0, -3.0], [2.0, 3.0, 0.0]],
        ),
        (REAL + "2 1 0\n", [[0.0], [0.0]]),
    ],
)
def test_what_is_read(tmp_path, text, right):
    assert read(tmp_path, text).tolist() == right


@pytest.mark.parametrize("shape", ["general", "symmetric", "skew-symmetric"])
@pytest.mark.parametrize("form", [np.asarray, scipy.sparse.coo_array])
def test_what_scipy_writes(tmp_path, form, shape):
    """Of every layout and symmetry, against the matrix that was written."""
    any_ = np.random.default_rng(4).standard_normal((7, 7)) * (np.arange(49).reshape(7, 7) % 3 > 0)
    matrix = {"general": any_, "symmetric": any_ + any_.T, "skew-symmetric": any_ - any_.T}[shape]
    scipy.io.mmwrite(tmp_path / "K.mtx", form(matrix), symmetry=shape, precision=17)
    assert (read_matrix_market(tmp_path / "K.mtx", Files()).toarray() == matrix).all()


def test_what_scipy_writes_of_complex_numbers(tmp_path):
    matrix = np.array([[1.0, 2.0 - 1.0j], [2.0 + 1.0j, 3.0]])
    scipy.io.mmwrite(tmp_path / "K.mtx", scipy.sparse.coo_array(matrix), symmetry="hermitian")
    assert (read_matrix_market(tmp_path / "K.mtx", Files()).toarray() == matrix).all()


@pytest.mark.parametrize(
    "text, said",
    [
        (REAL + "2 2 2\n1 1 100,5\n2 2 1\n", ['line 3: "100,5" has a decimal comma: write 100.5']),
        (
            REAL + "2 2 2\n\n1 1 2\n2 2 100.5kN\n",
            ['line 5: "100.5kN" has "kN" behind the number: write 100.5'],
        ),
        (REAL + "1 1 1\n1 1 100.5 kN\n", ['line 3: must be row, column and value, is "1 1 100.5 kN"']),
        (REAL + "1 1 1\n1 1 1.5 0.0\n", ['line 3: must be row, column and value, is "1 1 1.5 0.0"']),
        (REAL + "1 1 1\n1 1\n", ['line 3: must be row, column and value, is "1 1"']),
        (REAL + "1 1 1\n1.0 1 2\n", ["line 3: a row and a column are whole numbers"]),
        (REAL + "1 1 1\n1 99999999999999999999 2\n", ["line 3: a row and a column are whole numbers"]),
        (REAL + "1 1 1\n1 1 nan\n", ['line 3: "nan" is not a number']),
        (REAL + "1 1 1\n1 1 -Infinity\n", ['line 3: "-Infinity" is not a number']),
        (REAL + "1 1 1\n1 1 1e999\n", ['line 3: "1e999" is too large for a number']),
        (REAL + "1 1 1\n1 1 1_000\n", ['"1_000" is not a number']),
        (REAL + "1 1 1\n1 1 0x10\n", ['"0x10" is hexadecimal: write it in decimals']),
        (REAL.replace("real", "integer") + "1 1 1\n1 1 2.5\n", ['line 3: "2.5" is not a whole number']),
        (
            REAL.replace("real", "complex") + "1 1 1\n1 1 2.5\n",
            ["row, column and the real and the imaginary part"],
        ),
        (REAL.replace("real", "pattern") + "1 1 1\n1 1\n", ["line 1: it is a pattern"]),
        (
            REAL + "2 2 2\n1 3 1\n0 1 1\n",
            ["line 3: entry (1, 3) is not within the 2 rows", "line 4: entry (0, 1)"],
        ),
        (
            SYMMETRIC + "2 2 4\n1 1 1\n1 2 5\n2 1 5\n2 2 1\n",
            [
                "line 4: entry (1, 2) is above the diagonal; of a symmetric matrix the lower triangle alone "
                "is given: leave it out, or write general in line 1"
            ],
        ),
        (
            SYMMETRIC + "2 2 3\n1 1 1\n1 2 5\n2 2 1\n",
            [
                "line 4: entry (1, 2) is above the diagonal; of a symmetric matrix the lower triangle alone "
                "is given: write it as (2, 1)"
            ],
        ),
        (SYMMETRIC + "2 3 1\n2 1 5\n", ["line 2: a symmetric matrix of 2 rows has 3 columns"]),
        (REAL + "2 2 3\n2 1 5\n1 1 1\n2 1 6\n", ["line 5: entry (2, 1) is there already, in line 3"]),
        (
            REAL + "2 2 3\n2 1 5\n1 1 1\n",
            ["line 2: there are to be 3 entries, and there are 2: it is cut off"],
        ),
        (REAL + "2 2 1\n2 1 5\n1 1 1\n", ["line 2: there are to be 1 entries, and there are 2"]),
        (
            SYMMETRIC.replace("coordinate", "array") + "2 2\n1\n2\n2\n4\n",
            ["to be 3 entries, and there are 4"],
        ),
        (REAL + "2 2\n1 1 1\n", ['line 2: must be the whole numbers of rows, columns and entries, is "2 2"']),
        (REAL + "2 2 1.0\n1 1 1\n", ["line 2: must be the whole numbers of rows, columns and entries"]),
        (REAL + "% only a comment\n", ["there is no line of sizes"]),
        ("2 2 1\n1 1 1\n", ['line 1: must be such as "%%MatrixMarket matrix coordinate real symmetric"']),
        (
            REAL.replace("general", "symetric") + "1 1 1\n1 1 1\n",
            ['"symetric" is none of "general", "symmetric"'],
        ),
        (REAL.replace("general", "hermitian") + "1 1 1\n1 1 1\n", ["cannot be hermitian: write symmetric"]),
        ("\ufeff".join(("", REAL)).encode("utf-16"), ["text in UTF-16: save it as UTF-8"]),
        ("", ["line 1: must be such as"]),
    ],
)
def test_what_is_refused(tmp_path, text, said):
    found = faults(tmp_path, text)
    assert len(found) == len(said) and all(one.startswith('"K.mtx", ') for one in found)
    assert all(words in one for words, one in zip(said, found, strict=True))


def test_every_line_at_fault_is_told_or_counted(tmp_path):
    found = faults(tmp_path, REAL + "9 9 9\n" + "".join(f"{i} {i} {i},5\n" for i in range(1, 10)))
    assert len(found) == 6 and "line 7" in found[4] and found[-1] == '"K.mtx": 4 more such lines'

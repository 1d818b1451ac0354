"""Read the universal files that `convert` wrote with pyuff and compare every bit.

    python check_written.py

needs numpy and pyuff. The numbers are those of `bits` in src/convert/tests.rs.
"""

from pathlib import Path

import numpy as np
import pyuff

HERE = Path(__file__).parent
STEP = np.arange(257)


def expected(name):
    """The channels as the test has them."""
    return {"velocity of mass x": STEP / 3.0 - 41.0, "displacement of mass x": 1e-7 / (1.0 + STEP)}[name]


def main():
    sets = {}
    for name in ("written_binary.uff", "written_text.uff"):
        sets[name] = pyuff.UFF(str(HERE / name)).read_sets()
        assert len(sets[name]) == 6, len(sets[name])
    raw = (HERE / "written_binary.uff").read_bytes()
    for number, (binary, text) in enumerate(zip(*sets.values())):
        assert binary["id1"] == text["id1"]
        assert binary["id2"].strip() == f"run {number // 2 + 1}"
        assert binary["id4"].strip() == "clearance_m=0.0005; sweep=up"
        values = np.asarray(binary["data"])
        # the doubles of the file, bit by bit
        assert raw.find(values.astype("<f8").tobytes()) > 0
        np.testing.assert_array_equal(values, expected(binary["id1"].strip()))
        np.testing.assert_allclose(text["data"], values, rtol=1e-12)
        if number < 4:
            assert binary["abscissa_inc"] == 1 / 2000, binary["abscissa_inc"]
            assert binary["abscissa_spec_data_type"] == 17
        assert binary["ordinate_axis_units_lab"].strip() == ("mm/s", "m")[number % 2]
        assert len(values) == binary["num_pts"] == 257
    print("pyuff", pyuff.__version__, "reads both files; the binary one bit by bit")


if __name__ == "__main__":
    main()

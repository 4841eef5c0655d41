"""Rows of the pin on disc from products whose numbers are known."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.products import InterfaceLaw, LockIn, PinOnDisc, Transient
from pipeline.validation.pin_on_disc import pin_on_disc_rows
from tests.views.products_for_views import filled

pytestmark = pytest.mark.exact
KNOWN = {"test_length": 0.1515, "further_length": 0.1815}


def system():
    return filled(PinOnDisc, disc_frequency=[313.0, 440.0, 1018.0, 2251.0, 3100.0], disc_diameters=[0, 1, 2, 3, 1],
                  disc_out_of_plane=[0.0, 0.98, 0.95, 0.93, 0.0], pin_length=[0.1515, 0.1465],
                  pin_frequency=[[340.0, 340.0, 2105.0, 2105.0], [362.0, 362.0, 2245.0, 2245.0]])


def lock_in():
    return filled(LockIn, scan=["case", "case", "case", "length"], length=[0.1515, 0.1815, 0.1815, 0.1465],
                  base_mass=[0.005, 0.005, 0.5, 0.005], root=2 * np.pi * 1j * np.array([2190, 4000, 1440, 2250]) + 100,
                  kind=["classical", "multiple", "dual base", "classical"],
                  settled=[1, 1, 0, 1], base=[2216.0, 4050.0, 2280.0, 2220.0])


def transient():
    amplitude = np.array([[[1, 0.1, 0.03, 0.01, 0.004, 0.001], [1, 0.01, 0.002, 0.0003, 0.002, 0.0001]]])
    return filled(Transient, sensor_name=["pin", "disc"], harmonic_amplitude=amplitude, settled=[[1, 1]],
                  cycle_amplitude=[[1.0, 1.0]])


def rows(**products):
    nothing = dict.fromkeys(("interface_law", "transient", "lock_in"))
    return pin_on_disc_rows({"pin_on_disc": system(), **nothing, **products}, (), KNOWN)


def test_modes_by_their_shape():
    found = rows()
    assert [found[f"disc_{key}_test"].value for key in ("rocking", "20", "30")] == [440, 1018, 2251]
    assert (found["pin_first_test"].value, found["pin_second_test"].value) == (362, 2245)
    assert found["pin_second_151"].value == 2105
    assert found["pin_second_181"].value is None


def test_cases_of_the_map_count_and_the_heaviest_base_gives_the_fit():
    found = rows(lock_in=lock_in())
    assert found["lock_in_test"].value == found["lock_in_151"].value == 2216
    assert found["lock_in_181"].value == pytest.approx(1440, abs=1) and "(fitted)" in found["lock_in_181"].note
    assert "NOT settled" in found["lock_in_181"].note and "classical, settled" in found["lock_in_test"].note
    assert "lock_in_matched" not in found, "146.5 mm is only a point of the map"
    assert found["vibrations_grow"].value == pytest.approx(100)


def test_the_paper_s_step_shifts_the_growing_mode():
    """2250 Hz are shown at 2193 Hz by steps of 40 us."""
    found = pin_on_disc_rows({"pin_on_disc": system(), "interface_law": None, "transient": None,
                              "lock_in": replace(lock_in(), root=np.full(4, 100 + 2j * np.pi * 2250))}, (),
                             {**KNOWN, "time_step": 4e-5})
    assert "growing mode at 2250 Hz, which the trapezoidal rule at the paper's step shows at 2193 Hz" in (
        found["lock_in_151"].note)


def test_a_motion_that_still_grows_gives_its_line_where_no_settled_one_is_known():
    growing = replace(transient(), settled=np.array([[0, 0]]), cycle_frequency=np.array([[2134.0, 2137.0]]))
    assert rows(transient=growing)["lock_in_151"].value == 2137 and "still growing" in (
        rows(transient=growing)["lock_in_151"].note)
    assert rows(transient=growing, lock_in=lock_in())["lock_in_151"].value == 2216
    assert "lock_in_151" not in rows(transient=transient())


def test_harmonics():
    found = rows(transient=transient())
    assert found["pin_harmonics"].value == 5
    assert found["disc_harmonics"].value == 4
    assert found["pin_harmonics_fall"].value == pytest.approx(20 * np.log10(2.5))
    assert found["disc_harmonics_do_not_fall"].value == pytest.approx(-20 * np.log10(0.002 / 0.0003))


def test_ranges_of_the_interface_law():
    displacement = np.linspace(0, 1e-6, 101)
    law = filled(InterfaceLaw, gap=[3e-6, 2e-6, 0.0], gap_pressure=[1.0, 1e6, 1e8], displacement=displacement,
                 shear=[np.minimum(displacement * 1e13, 2e6)], limit=[2e6])
    found = rows(interface_law=law)
    assert found["gap_range"].value == pytest.approx(2e-6)
    assert found["full_slip"].value == pytest.approx(2e-7)

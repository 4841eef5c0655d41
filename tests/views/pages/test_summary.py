"""The first screen says what the products say."""

from dataclasses import fields, replace

import numpy as np
import pytest

from pipeline.views.pages.summary import published_squeal, verdict
from tests.views import products_for_views as small


def said(given):
    return " ".join(answer for _, answer in given.answers)


def test_squeal_is_told_with_place_level_and_frequency():
    told = verdict(small.products(), (("micro_friction.shear_limit", "13.5 MPa"),))
    assert told.tone == "squeal"
    assert told.headline == "Squeal at 2 of 9 operating points"
    assert "3\u202fMPa, 12\u202frad/s" in said(told)
    assert "92 dB" in said(told)
    assert "16.6\u202fkHz" in said(told)


def test_agreement_counts_only_what_was_not_tuned():
    told = said(verdict(small.products(), ()))
    assert "Of 7 published facts, 5 are testable" in told
    assert "4 are met within tolerance, 3 of them because the model was tuned" in told
    assert "At most 1 are independent evidence" in told


def test_a_peak_without_unstable_mode_is_called_forced():
    squeal = small.squeal()
    moved = replace(squeal, peak_frequency=0.8 * squeal.peak_frequency)
    assert "it is forced by the pads" in said(verdict(small.products(squeal=moved), ()))
    assert "it is forced by the pads" not in said(verdict(small.products(), ()))
    stable = verdict(small.products(complex_modes=small.complex_modes(stable=True)), ())
    assert "No mode is unstable" in said(stable)


def test_a_loudest_peak_that_is_a_harmonic_is_told_as_one():
    told = said(verdict(small.products(squeal=small.squeal(harmonic=True)), ()))
    assert "It is the 20th harmonic of 0.83\u202fkHz. Harmonics of a lower fundamental: 1 of 2 events." in told
    assert "harmonic" not in said(verdict(small.products(), ()))


def test_quiet_and_unstable_brakes_are_told_apart():
    quiet = small.products(squeal=small.squeal(quiet=True))
    assert verdict(quiet, ()).headline == "No peak exceeds the squeal threshold, but 1 mode is unstable"
    still = small.products(squeal=small.squeal(quiet=True), complex_modes=small.complex_modes(stable=True))
    assert verdict(still, ()).headline == "No squeal predicted"
    assert verdict(still, ()).tone == "quiet"


def test_a_chain_that_ends_with_complex_modes_says_whether_squeal_can_start_and_whether_that_is_converged():
    ending = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    told = verdict(ending, ())
    assert told.headline.startswith("Squeal can start at 9 of 9 operating points, most strongly at 16.6")
    assert told.tone == "squeal" and "within 3\u202f%" in said(told)
    assert "Converged at 3\u202fMPa and 10.25\u202frad/s, where it was tried: the same modes are unstable" in said(told)
    told = verdict({**ending, "convergence": small.convergence(converged=False)}, ())
    assert told.headline.endswith("(not converged)") and told.tone == "warning"
    assert "8.037\u202fkHz: 360 becomes 250 1/s; 10.85\u202fkHz is gone" in said(told)
    assert "1 further unstable mode" in said(told)
    assert "What moved them most: mesh of the bracket, 110\u202f1/s." in said(told)
    stable = verdict({"complex_modes": small.complex_modes(stable=True), "convergence": small.convergence()}, ())
    assert stable.headline == "Steady sliding is stable at all 9 operating points" and stable.tone == "quiet"


def test_what_was_not_refined_is_said_and_never_called_converged():
    bases = replace(small.convergence(), refinement=np.array(["bases"]), refined_root=small.convergence().root,
                    left_out=np.array(["disc_mesh", "contact"]), converged=np.array(0),
                    left_out_reason=np.array(["comes from a file", "was not asked for"]))
    told = verdict({"complex_modes": small.complex_modes(), "convergence": bases}, ())
    assert told.headline.endswith("(not shown to be converged: no mesh was refined)") and told.tone == "warning"
    assert "Not shown to be converged: no mesh was refined. The same modes are unstable without the reduction" in \
        said(told) and "Converged" not in said(told)
    assert "Not refined, and of unknown error: mesh of the disc and contact points." in said(told)


@pytest.mark.parametrize("refined, left_out, words", [
    (["contact", "pad_mesh", "bases"], ["disc_mesh"], "mesh of the disc was not refined"),
    (["contact", "bases"], ["disc_mesh", "pad_mesh"], "mesh of the disc and mesh of the pads were not refined"),
    (["contact", "bases"], ["disc_mesh", "pad_mesh", "caliper_mesh"], "3 of 5 parts were not refined")])
def test_the_headline_says_in_short_what_was_not_refined(refined, left_out, words):
    partly = replace(small.convergence(), refinement=np.array(refined), left_out=np.array(left_out),
                     left_out_reason=np.array(["comes from a file"] * len(left_out)), converged=np.array(0))
    told = verdict({"complex_modes": small.complex_modes(), "convergence": partly}, ())
    assert told.headline.endswith(f"(not shown to be converged: {words})")


def test_a_share_beyond_the_tolerance_that_a_small_growth_rate_has_is_no_claim():
    """55 % of 16 1/s are within 10 1/s."""
    slow = replace(small.convergence(), growth_share=np.array(0.55), growth_change=np.array(9.0))
    told = said(verdict({"complex_modes": small.complex_modes(), "convergence": slow}, ()))
    assert "growth rates within 9\u202f1/s" in told and "55" not in told.partition("growth rates")[2][:20]


def test_unstable_modes_below_squeal_are_told_as_groan_or_moan():
    modes, ending = small.complex_modes(), small.convergence()
    all_low = verdict({"complex_modes": replace(modes, squeal_from=20e3), "convergence": ending}, ())
    assert all_low.headline.startswith("No squeal, but groan or moan at 16.6") and all_low.tone == "warning"
    roots = modes.unstable_root.copy()
    roots[-1] = 25.0 + 2j * np.pi * 242.0
    told = verdict({"complex_modes": replace(modes, unstable_root=roots), "convergence": ending}, ())
    assert told.headline.startswith("Squeal can start at 8 of 9 operating points")
    assert "Below squeal, 242\u202fHz grows at 1\u202fMPa (groan or moan, by up to 25\u202f1/s)." in said(told)
    assert "Below squeal" not in said(verdict({"complex_modes": modes, "convergence": ending}, ()))


def test_what_to_change_is_told_where_sensitivities_are_known():
    ending = {"complex_modes": small.complex_modes(), "convergence": small.convergence()}
    told = dict(verdict({**ending, "sensitivities": small.sensitivities()}, ()).answers)
    assert told["What to change"].startswith("What matters most for the mode at 10.9")
    assert "What to change" not in dict(verdict(ending, ()).answers)


def test_a_simulated_brake_squeals_and_says_how_loud():
    modes, ending = small.complex_modes(), small.convergence()
    told = verdict({"complex_modes": modes, "convergence": ending, "limit_cycle": small.limit_cycle()}, ())
    points = len(np.unique(modes.unstable_operating))
    assert told.headline == f"Squeals at {points} of 9 operating points, loudest at 8.05\u202fkHz"
    assert "Every motion settles" in said(told) and "0.05 dB" in said(told)
    doubtful = verdict({"complex_modes": modes, "convergence": ending,
                        "limit_cycle": small.limit_cycle(settled=False)}, ())
    assert "1 of 2 motions has NOT settled" in said(doubtful)


def test_how_likely_says_where_how_much_and_what_matters():
    product = small.probability()
    answers = dict(verdict({"complex_modes": small.complex_modes(), "probability": product}, ()).answers)
    said = answers["How likely"].replace("\N{NARROW NO-BREAK SPACE}", " ")
    assert f"{100 * product.probability.max():.3g}" in said and "3 MPa" in said
    assert "What matters most: friction (70" in said and "less stable), then damping speed" in said
    assert "more stable" in said
    blurred = dict(verdict({"complex_modes": small.complex_modes(), "probability": replace(
        product, sensitivity_error=product.sensitivity + 0.1)}, ()).answers)["How likely"]
    assert "matters most" not in blurred and "No source stands out" in blurred
    assert "How likely" not in dict(verdict({"complex_modes": small.complex_modes()}, ()).answers)


def test_a_cycle_without_an_unstable_mode_is_told():
    """Stick-slip: steady sliding is stable, the motion is not quiet. A motion that has not settled is no cycle."""
    stable = {"complex_modes": small.complex_modes(stable=True)}
    told = verdict({**stable, "transient": small.transient()}, ())
    assert told.headline == "Vibration at 2.2\u202fkHz although no mode is unstable" and told.tone == "warning"
    assert verdict({**stable, "transient": small.transient(settled=False)}, ()).headline == "No squeal predicted"
    assert verdict(stable, ()).headline == "No squeal predicted"


def test_a_case_that_ends_early_gets_no_verdict():
    told = verdict({"surface": small.surface()}, ())
    assert told.headline.startswith("No verdict")
    assert told.facts == ()


def test_published_squeal_lines_come_from_the_comparison_in_hertz():
    np.testing.assert_allclose(published_squeal(small.comparison()), [16600.0, 17800.0])
    assert published_squeal(None) == ()


def test_a_comparison_with_nothing_is_none():
    """A brake of one's own: comparison: {reference: null}."""
    comparison = small.comparison()
    none = replace(comparison, **{f.name: getattr(comparison, f.name)[:0] for f in fields(comparison)
                                  if f.metadata.get("dims", ("",))[0] == "row"})
    told = said(verdict(small.products(comparison=none), (("a.b", "1"),)))
    assert "no published result to compare with" in told and "published facts" not in told
    assert "does not state on which facts" not in told


def test_tuned_settings_without_tuned_facts_are_told():
    comparison = small.comparison()
    untold = replace(comparison, tuned=[""] * len(comparison.row))
    settings = (("micro_friction.shear_limit", "13.5 MPa"),)
    assert "does not state on which facts" in said(verdict(small.products(comparison=untold), settings))
    assert "does not state on which facts" not in said(verdict(small.products(), settings))
    assert "Nothing in this case is marked as tuned" in said(verdict(small.products(comparison=untold), ()))

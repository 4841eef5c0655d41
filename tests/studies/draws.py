"""'make study_draws': growing roots of draws of the scatter beside all roots of the same matrices by LAPACK.

Draws of a seed that no case uses are solved twice at every pressure of the reduced model of a run, at the middle speed:
as the stage probability solves them, and for all eigenvalues of the companion matrix. Prints how often both have the
same growing modes, how far their growth rates lie apart, and what share of the draws has one by each.
"""

import argparse
import os
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context

import numpy as np
import scipy

from pipeline.case_models.operating_points import StabilitySettings, middle_speed
from pipeline.case_models.scatter import DEFAULT, Source, draw_values, factors_of, family, fitting, friction_errors
from pipeline.contract.settings import fill
from pipeline.environment import ONE_THREAD
from pipeline.physics.stability.draws.draw_statistics import rate_interval
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from tests.benchmarks.brake_kernels import brake

#: further draws that the common bases serve, as in the settings of the stage
TRAINING = 5
#: growth rates and frequencies of the same root differ by no more, 1/s and rad/s
_SAME = 1.0


@dataclass(frozen=True)
class Beside:
    """Growing roots of one draw at one pressure, 1/s, as the stage finds them, ``made``, and by LAPACK, ``exact``."""

    made: np.ndarray
    exact: np.ndarray

    @property
    def pairs(self):
        """(made, exact) of the roots that both have."""
        made, exact = np.nonzero(abs(self.made[:, None] - self.exact) < _SAME)
        return self.made[made], self.exact[exact]

    @property
    def same(self):
        """Whether both have the same growing modes."""
        return len(self.made) == len(self.exact) == len(self.pairs[0])


def cases(draws, seed, small=False):
    """([Sampled of each pressure], [Factors of each draw], speed rad/s, least growth as a share of the frequency)."""
    model, law, modes = brake(small)
    points = StabilitySettings.of(modes)
    sources = fitting([fill(Source, given, "source") for given in DEFAULT], model)
    errors = friction_errors(law, points.sliding_distance)
    drawn = [factors_of(sources, row, model)
             for row in draw_values(sources, errors, draws + TRAINING, np.random.default_rng(seed))]
    training, speed = (NOMINAL, *drawn[draws:]), middle_speed(points.speeds)
    families = [family(model, state, law, points) for state in range(len(model.pressure))]
    return ([sampled(each, [speed], points.frequency_max, training) for each in families], drawn[:draws], speed,
            points.neutral)


def beside(case, speed, neutral, factors):
    """Beside of a draw of Factors on the bases of a Sampled."""
    (damping, stiffness, change), _ = case.system(factors, speed)
    below, size = 2 * np.pi * case.below, len(damping)
    upper = np.hstack((np.zeros((size, size)), below * np.eye(size)))
    lower = -np.hstack(((stiffness + change) / below, damping))
    every = scipy.linalg.eigvals(np.vstack((upper, lower)), overwrite_a=True, check_finite=False)
    every = every[(every.imag > 0) & (every.imag < below)]
    return Beside(*(np.sort_complex(roots[roots.real > neutral * abs(roots)])
                    for roots in (case.roots(factors, speed), every)))


def told(found):
    """Sentences on [pressure][draw] of Beside."""
    flat = [each for of_case in found for each in of_case]
    apart = np.concatenate([made.real - exact.real for made, exact in (each.pairs for each in flat)])
    growing = np.array([[len(getattr(each, kind)) > 0 for each in of_case] for kind in ("made", "exact")
                        for of_case in found]).reshape(2, len(found), -1).any(axis=1)
    worst = f"{abs(apart).max():.2g} 1/s at most" if len(apart) else "nothing to compare"
    shares = (f"{kind.mean():.3f} ({', '.join(f'{end:.3f}' for end in rate_interval(kind.sum(), len(kind)))})"
              for kind in growing)
    return (f"the same growing modes: {sum(each.same for each in flat)} of {len(flat)} sets,"
            f" {sum(len(each.exact) for each in flat)} roots by LAPACK",
            f"growth rates differ by {worst}",
            "share of the draws with a growing mode: {} as the stage solves them, {} by LAPACK".format(*shares))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seed", type=int, default=977)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    every, drawn, speed, neutral = cases(asked.draws, asked.seed)
    with get_context("spawn").Pool(asked.workers) as pool:
        found = [pool.map(partial(beside, case.compact(), speed, neutral), drawn, chunksize=1) for case in every]
    print("\n".join(told(found)))


if __name__ == "__main__":
    os.environ.update(ONE_THREAD)
    main()

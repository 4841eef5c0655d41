"""Rigs whose hidden laws really switch: SciPy's solve_ivp stops at every event, coarse samples, unknown starts."""

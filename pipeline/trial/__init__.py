"""Generators of concealed cases: own equations, bases and integrators, apart from effects and diagnosis."""

"""Constants of isotropic elasticity from Young's modulus E and Poisson's ratio nu; numbers or arrays."""


def shear_modulus(young, poisson):
    """G = E / (2 (1 + nu)) in the unit of E."""
    return young / (2 * (1 + poisson))


def first_modulus(young, poisson, plane_stress=False):
    """Lame's lambda in the unit of E: 2 G nu / (1 - 2 nu), or that of the plane problem, E nu / (1 - nu^2)."""
    if plane_stress:
        return young * poisson / (1 - poisson**2)
    return 2 * shear_modulus(young, poisson) * poisson / (1 - 2 * poisson)


def plane_strain_modulus(young, poisson):
    """E / (1 - nu^2) in the unit of E, which contact of half-spaces and bending of plates see."""
    return young / (1 - poisson**2)

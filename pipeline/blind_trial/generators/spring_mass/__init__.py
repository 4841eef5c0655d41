"""Spring-mass rigs: linear chains with an effect inserted at one location."""

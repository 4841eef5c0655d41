"""A lining of several materials: particles and fibres in resin, as finite elements of different moduli."""

"""Time signals: forward model, latent forces and localisation."""

"""Where to look: score tests, localisation and latent forces."""

"""From products and settings to a bench: laws, sensors, runs, nominal parameters, effects."""

"""Truth for trials of the diagnosis: rigs, hidden physics, sensors and files, apart from what solves them.

Nothing here imports the models, effects or numerics of the diagnosis, and nothing there imports this.
"""
